// Division by zero returns 0, or raises a UsageFault if CCR.DIV_0_TRP is set.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t ccr = 0xE000ED14, cfsr = 0xE000ED28, shcsr = 0xE000ED24;
volatile std::uint32_t faults = 0, bits = 0, instruction = 0;

extern "C" void note_division(std::uint32_t* frame) {
  faults = faults + 1;
  bits = word(cfsr);
  word(cfsr) = bits;
  instruction = half(frame[6]);
  frame[6] += 4;
}
[[gnu::naked]] void fault() { asm volatile("mov r0, sp\n push {r4, lr}\n bl note_division\n pop {r4, pc}"); }

[[gnu::noinline]] std::uint32_t divide(std::uint32_t dividend, std::uint32_t divisor) {
  std::uint32_t quotient = 77;
  // The block computes the divisor, so that its value is not known at the start of the block.
  asm volatile("add r3, %2, #0\n udiv %0, %1, r3" : "+r"(quotient) : "r"(dividend), "r"(divisor) : "r3");
  return quotient;
}

}  // namespace

void run() {
  set_handler(6, fault);
  word(shcsr) = 1 << 18;
  results[1] = divide(7, 0);
  results[2] = faults;
  word(ccr) |= 1 << 4;
  results[3] = divide(7, 2);
  results[4] = faults;
  results[5] = divide(7, 0);
  results[6] = faults;
  results[7] = bits;
  results[8] = instruction & 0xFFF0;
  word(ccr) &= ~(1u << 4);
  results[9] = divide(9, 0);
  results[10] = faults;
  results[0] = finished;
}
