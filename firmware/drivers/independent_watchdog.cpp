#include "firmware/drivers/independent_watchdog.hpp"

#include <board/board.hpp>
#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {
namespace {

using IWDG = RegistersOf<IndependentWatchdog, registers::IWDG>;

constexpr std::uint32_t key_start = 0xCCCC, key_unlock = 0x5555, key_feed = 0xAAAA;
constexpr std::uint32_t divider = 4;  // the reset value, because only a reset stops the watchdog
constexpr std::uint32_t reload =
    IndependentWatchdog::oscillator_Hz / divider * IndependentWatchdog::timeout_ms / 1000 - 1;

}  // namespace

bool IndependentWatchdog::start() {
  using Freeze = registers::DBG::DBGMCU_APB1_FZ;
  Freeze::modify(Freeze::DBG_IWDG_STOP(1));
  // The start key starts the watchdog and the watchdog oscillator. Without the oscillator, new register values would
  // never take effect.
  IWDG::KR::write(key_start);
  IWDG::KR::write(key_unlock);
  IWDG::RLR::write(IWDG::RLR::RL(reload));
  // A register update takes five oscillator cycles. If the update fails, the default timeout of 0.5 s remains active.
  const bool is_taken = wait_for(board::processor_Hz / 200, [] { return IWDG::SR::read() == 0; });
  feed();
  return is_taken && IWDG::RLR::read() == reload;
}

void IndependentWatchdog::feed() { IWDG::KR::write(key_feed); }

}  // namespace inkwell::drivers
