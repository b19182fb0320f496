// Measures short programs with the core's cycle counter. The cycle counts follow from the manuals. Each program runs
// with 16 and with 48 repetitions, so that the overhead cancels.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t flash_acr = 0x40023C00;
constexpr std::uint32_t apb1_divided_by_4 = 5 << 10, gpio_clock = 1, tim2_clock = 1;
std::uint32_t data[8];
/// Two flash lines.
alignas(16) constexpr std::uint32_t table[8] = {1, 2, 3, 4, 5, 6, 7, 8};

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
PROGRAM(reads_of_two_lines, "ldr r1, [r0]\n ldr r2, [r0, #16]\n adds r3, r3, #1")
PROGRAM(reads, "ldr r1, [r0]\n adds r3, r3, #1")

std::uint32_t time(void (*program)(std::uint32_t*), std::uint32_t* at = data) {
  program(at);  // fills the caches
  const std::uint32_t before = cycles();
  program(at);
  return cycles() - before;
}

#define DIFFERENCE_AT(name, at) (time(name##_48, at) - time(name##_16, at))
#define DIFFERENCE(name) DIFFERENCE_AT(name, data)

/// The 1024 additions of the long loop (256 flash lines) exceed the cache. The 32 additions of the short loop do not.
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
  auto* const tim2 = reinterpret_cast<std::uint32_t*>(timer::tim2);
  auto* const gpio_a = reinterpret_cast<std::uint32_t*>(gpio::a);
  word(rcc::ahb1enr) |= gpio_clock;
  word(rcc::apb1enr) |= tim2_clock;
  results[18] = DIFFERENCE_AT(reads, gpio_a);
  results[19] = DIFFERENCE_AT(reads, tim2);
  word(rcc::cfgr) |= apb1_divided_by_4;
  results[20] = DIFFERENCE_AT(reads, tim2);
  word(rcc::cfgr) &= ~apb1_divided_by_4;
  // Five wait states with the instruction cache, then also with the data cache.
  auto* const constants = const_cast<std::uint32_t*>(table);
  results[21] = DIFFERENCE_AT(reads_of_two_lines, constants);
  word(flash_acr) = 0x205;
  results[22] = DIFFERENCE_AT(reads_of_two_lines, constants);
  word(flash_acr) = 0x605;
  results[23] = DIFFERENCE_AT(reads_of_two_lines, constants);
  // No wait states; then five wait states without acceleration, with prefetch, and with prefetch and both caches.
  const std::uint32_t access[] = {0, 5, 0x105, 0x705};
  for (unsigned i = 0; i < 4; ++i) {
    word(flash_acr) = access[i];
    results[10 + i] = time(long_loop);
    results[14 + i] = time(short_loop);
  }
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
