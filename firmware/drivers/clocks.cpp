#include "firmware/drivers/clocks.hpp"

#include <board/board.hpp>
#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {
namespace {

using registers::FLASH;
using registers::PWR;
using registers::RCC;

/// Time limit of 0.1 s in cycles of the internal oscillator. The internal oscillator runs while the crystal and the PLL
/// start.
constexpr std::uint32_t start_cycles = internal_oscillator_Hz / 10;

/// Returns the PPREx code for a bus divider of 1, 2, 4, 8 or 16 (RCC_CFGR).
constexpr std::uint32_t bus_divider_code(std::uint32_t divider) {
  std::uint32_t code = 0;
  while (divider > 1) {
    divider /= 2;
    code = code == 0 ? 0b100 : code + 1;
  }
  return code;
}
static_assert(bus_divider_code(1) == 0 && bus_divider_code(2) == 0b100 && bus_divider_code(16) == 0b111);

/// Selects the internal oscillator and switches the PLL off. The boot loader may have started the PLL, and a running
/// PLL cannot be changed.
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

  // Voltage scale 1 is required for 168 MHz. A boot loader may have changed the voltage scale.
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

  // Wait states and bus dividers must change before the frequency increases.
  FLASH::ACR::write(FLASH::ACR::LATENCY(board::flash_wait_states), FLASH::ACR::PRFTEN(1), FLASH::ACR::ICEN(1),
                    FLASH::ACR::DCEN(1));
  if (!wait_for(start_cycles, [] { return FLASH::ACR::LATENCY::read() == board::flash_wait_states; })) return false;
  RCC::CFGR::modify(RCC::CFGR::PPRE1(bus_divider_code(board::apb1_divider)),
                    RCC::CFGR::PPRE2(bus_divider_code(board::apb2_divider)));
  constexpr std::uint32_t from_pll = 0b10;
  RCC::CFGR::modify(RCC::CFGR::SW(from_pll));
  if (!wait_for(start_cycles, [] { return RCC::CFGR::SWS::read() == from_pll; })) return false;

  // Without clock security, the last duty cycle would remain on the motors if the crystal stopped.
  RCC::CR::modify(RCC::CR::CSSON(1));
  return true;
}

bool crystal_oscillates() { return RCC::CR::HSERDY::is_set(); }

}  // namespace inkwell::drivers
