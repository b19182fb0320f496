// Thousands of IT blocks, interrupted at arbitrary instructions by SysTick and by stops of the simulation.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t rounds = 20'000;
volatile std::uint32_t ticks;
// The comparison changes the flags, which the exception return must restore.
void systick() {
  if (ticks + 1 != 0) ticks = ticks + 1;
}

/// The last instruction of the block is in the next memory page. The block is in a separate function,
/// because the literals must be near the block.
[[gnu::naked, gnu::noinline]] std::uint32_t added_across_pages() {
  asm volatile(
      "movs r0, #0\n ldr r1, =%c0\n b 1f\n .ltorg\n .balign 4096\n .space 4084\n"
      "1: tst.w r1, #1\n"
      "itttt ne\n addne r0, #1\n addne r0, #1\n addne r0, #1\n addne.w r0, r0, #256\n"
      "subs r1, #1\n bne 1b\n bx lr" ::"i"(rounds));
}

}  // namespace

void run() {
  set_handler(15, systick);
  word(0xE000E014) = 96;  // a period without a common factor with the loop length
  word(0xE000E018) = 0;
  word(0xE000E010) = 7;
  std::uint32_t even = 0, odd = 0, left = rounds;
  asm volatile(
      "1: tst %2, #1\n"
      "itete eq\n addeq %0, #1\n addne %1, #1\n addeq.w %0, %0, #256\n addne.w %1, %1, #256\n"
      "ittt ne\n addne %1, #1\n addne %1, #1\n addne.w %1, %1, #512\n"
      "it eq\n addeq.w %0, %0, #4096\n"
      // Like a library's multiplication, this block contains comparisons and a call that is never executed.
      "movs r3, #1\n ands r4, r3, #1\n"
      "ittte ne\n andsne r5, r3, #1\n teqne r4, #2\n teqne r5, #2\n bleq 2f\n"
      "subs %2, #1\n bne 1b\n b 3f\n"
      "2: movs %0, #0\n bx lr\n"
      "3:"
      : "+l"(even), "+l"(odd), "+l"(left)
      :
      : "r3", "r4", "r5", "lr", "cc");
  results[4] = added_across_pages();
  word(0xE000E010) = 0;
  results[1] = even;
  results[2] = odd;
  results[3] = ticks;
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
