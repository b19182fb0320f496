// An IT block across a page boundary, interrupted as often as possible. The condition of the block would skip the first
// instruction of the handler.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t rounds = 20'000;

/// Adds to R4 the value that its first instruction writes to R2. The exception return restores the changed flags.
[[gnu::naked]] void systick() { asm volatile("movs r2, #1\n adds r4, r2\n bx lr"); }

/// R2 is always 0. Every second iteration adds 3 + 256. The timer runs only inside this function, because its handler
/// changes R4.
[[gnu::naked, gnu::noinline]] std::uint32_t added_across_pages() {
  asm volatile(
      "push {r4}\n movs r0, #0\n movs r4, #0\n"
      "ldr r1, =0xE000E010\n movs r2, #7\n str r2, [r1]\n movs r2, #0\n ldr r1, =%c0\n b 1f\n .ltorg\n .balign 4096\n "
      ".space 4084\n"
      "1: tst.w r1, #1\n"
      "itttt eq\n addeq r0, #1\n addeq r0, #1\n addeq r0, #1\n addeq.w r0, r0, #256\n"
      "movs r2, #0\n subs r1, #1\n bne 1b\n"
      "ldr r1, =0xE000E010\n str r2, [r1]\n dsb\n isb\n ldr r1, =%c1\n str r4, [r1]\n pop {r4}\n bx lr\n .ltorg" ::"i"(
          rounds),
      "i"(0x2001F008));
}

}  // namespace

void run() {
  set_handler(15, systick);
  word(0xE000E014) = 46;  // a period without a common factor with the loop length
  word(0xE000E018) = 0;
  results[1] = added_across_pages();
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
