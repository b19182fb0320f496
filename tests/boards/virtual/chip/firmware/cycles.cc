// Micro-programs whose count follows from the manuals, measured by the core's own cycle counter. Each is measured
// with 16 and with 48 repetitions, so that what surrounds it cancels.
#include "support.hpp"

namespace {

constexpr std::uint32_t flash_acr = 0x40023C00;
std::uint32_t data[8];

#define REPEATED(name, count, text)                                                                        \
  [[gnu::naked, gnu::noinline, gnu::aligned(16)]] void name(std::uint32_t*) {                              \
    asm volatile("movs r1, #1\n movs r2, #1\n .rept " #count "\n" text "\n .endr\n bx lr\n" ::: "memory"); \
  }
#define PROGRAM(name, text)     \
  REPEATED(name##_16, 16, text) \
  REPEATED(name##_48, 48, text)

PROGRAM(additions, "adds r1, #1")
PROGRAM(wide_additions, "add.w r1, r1, #1")
PROGRAM(two_loads, "ldr r1, [r0]\n ldr r2, [r0, #4]\n adds r3, r3, #1")
PROGRAM(stores, "str r1, [r0]\n adds r3, r3, #1")
PROGRAM(addresses, "adds r0, #0\n ldr r1, [r0]\n adds r3, r3, #1")
PROGRAM(float_chain, "vadd.f32 s0, s0, s1\n")
PROGRAM(float_pairs, "vadd.f32 s0, s0, s1\n vadd.f32 s2, s2, s3\n")
PROGRAM(accumulations, "vfma.f32 s0, s1, s2\n")
PROGRAM(divisions, "udiv r3, r0, r0\n")

std::uint32_t time(void (*program)(std::uint32_t*)) {
  program(data);  // what a cache may keep is there now
  const std::uint32_t before = cycles();
  program(data);
  return cycles() - before;
}

#define DIFFERENCE(name) (time(name##_48) - time(name##_16))

/// Loops over 1024 wide additions (256 lines of flash), which no cache holds, and over 32.
[[gnu::naked, gnu::noinline, gnu::aligned(16)]] void long_loop(std::uint32_t*) {
  asm volatile("movs r1, #3\n 1: .rept 1024\n add.w r2, r2, #1\n .endr\n subs r1, #1\n bne.w 1b\n bx lr\n" ::
                   : "memory");
}
[[gnu::naked, gnu::noinline, gnu::aligned(16)]] void short_loop(std::uint32_t*) {
  asm volatile("movs r1, #96\n 1: .rept 32\n add.w r2, r2, #1\n .endr\n subs r1, #1\n bne.w 1b\n bx lr\n" ::: "memory");
}

}  // namespace

void run() {
  start_cycle_counter();
  word(0xE000ED88) |= 0xF << 20;  // the FPU
  asm volatile("dsb\n isb" ::: "memory");
  results[1] = DIFFERENCE(additions);
  results[2] = DIFFERENCE(wide_additions);
  results[3] = DIFFERENCE(two_loads);
  results[4] = DIFFERENCE(stores);
  results[5] = DIFFERENCE(addresses);
  results[6] = DIFFERENCE(float_chain);
  results[7] = DIFFERENCE(float_pairs);
  results[8] = DIFFERENCE(accumulations);
  results[9] = DIFFERENCE(divisions);
  // No wait states; five of them with nothing on, with prefetch, with all of the accelerator.
  const std::uint32_t access[] = {0, 5, 0x105, 0x705};
  for (unsigned i = 0; i < 4; ++i) {
    word(flash_acr) = access[i];
    results[10 + i] = time(long_loop);
    results[14 + i] = time(short_loop);
  }
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
