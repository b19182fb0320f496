// An interrupt occurs between the firmware's check for pending work and its sleep instruction.
// SysTick ends an erroneous sleep after at most one millisecond.
#include "firmware/drivers/system.hpp"

#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

volatile bool has_work;

void find_work() { has_work = true; }
void tick() {}

}  // namespace

void run() {
  constexpr unsigned position = 7;
  constexpr std::uint32_t systick_control = 0xE000'E010, systick_reload = 0xE000'E014, pend_0 = 0xE000'E200;
  set_handler(interrupt(position), find_work);
  set_handler(15, tick);
  enable_interrupt(position, 0);
  word(systick_reload) = 16'000 - 1;
  word(systick_control) = 7;
  inkwell::drivers::sleep_unless([] {
    const bool answer = has_work;
    word(pend_0) = 1u << position;
    return answer;
  });
  results[1] = has_work;
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
