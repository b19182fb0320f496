#include <drivers/clocks.hpp>

#include <board/board.hpp>
#include <drivers/cycle_counter.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {
namespace {

using registers::FLASH;
using registers::PWR;
using registers::RCC;

/// A tenth of a second at the clock that runs while the crystal and the PLL start.
constexpr std::uint32_t start_cycles = internal_oscillator_Hz / 10;

/// Code of a bus divider of 1, 2, 4, 8 or 16 (RCC_CFGR, PPREx).
constexpr std::uint32_t bus_divider_code(std::uint32_t divider) {
  std::uint32_t code = 0;
  while (divider > 1) {
    divider /= 2;
    code = code == 0 ? 0b100 : code + 1;
  }
  return code;
}
static_assert(bus_divider_code(1) == 0 && bus_divider_code(2) == 0b100 && bus_divider_code(16) == 0b111);

/// Runs from the internal oscillator with the PLL off, as after a reset. The boot loader in the chip starts programs
/// without one, and a running PLL cannot be changed.
bool return_to_internal_oscillator() {
  constexpr std::uint32_t internal = 0b00;
  RCC::CR::modify(RCC::CR::HSION(1));
  if (!wait_for(start_cycles, [] { return RCC::CR::HSIRDY::is_set(); })) return false;
  RCC::CFGR::modify(RCC::CFGR::SW(internal));
  if (!wait_for(start_cycles, [] { return RCC::CFGR::SWS::read() == internal; })) return false;
  RCC::CR::modify(RCC::CR::PLLON(0));
  return wait_for(start_cycles, [] { return !RCC::CR::PLLRDY::is_set(); });
}

}  // namespace

bool start_clocks() {
  if (!return_to_internal_oscillator()) return false;

  // 168 MHz needs voltage scale 1. It is the default, but a boot loader may have changed it.
  RCC::APB1ENR::modify(RCC::APB1ENR::PWREN(1));
  static_cast<void>(RCC::APB1ENR::read());
  PWR::CR::modify(PWR::CR::VOS(1));

  RCC::CR::modify(RCC::CR::HSEON(1));
  if (!wait_for(start_cycles, [] { return RCC::CR::HSERDY::is_set(); })) return false;

  RCC::PLLCFGR::modify(RCC::PLLCFGR::PLLM(board::facts.pll_m()), RCC::PLLCFGR::PLLN(board::pll_n),
                       RCC::PLLCFGR::PLLP(board::pll_p / 2 - 1), RCC::PLLCFGR::PLLQ(board::pll_q),
                       RCC::PLLCFGR::PLLSRC(1));
  RCC::CR::modify(RCC::CR::PLLON(1));
  if (!wait_for(start_cycles, [] { return RCC::CR::PLLRDY::is_set(); })) return false;

  // Wait states before speed, and bus dividers before it too, so that no part is ever over its limit.
  FLASH::ACR::write(FLASH::ACR::LATENCY(board::flash_wait_states), FLASH::ACR::PRFTEN(1), FLASH::ACR::ICEN(1),
                    FLASH::ACR::DCEN(1));
  if (!wait_for(start_cycles, [] { return FLASH::ACR::LATENCY::read() == board::flash_wait_states; })) return false;
  RCC::CFGR::modify(RCC::CFGR::PPRE1(bus_divider_code(board::apb1_divider)),
                    RCC::CFGR::PPRE2(bus_divider_code(board::apb2_divider)));
  constexpr std::uint32_t from_pll = 0b10;
  RCC::CFGR::modify(RCC::CFGR::SW(from_pll));
  if (!wait_for(start_cycles, [] { return RCC::CFGR::SWS::read() == from_pll; })) return false;

  // A dead crystal would leave the last duty on the motors: the security system turns it into a fault.
  RCC::CR::modify(RCC::CR::CSSON(1));
  return true;
}

bool crystal_swings() { return RCC::CR::HSERDY::is_set(); }

}  // namespace inkwell::drivers
