#include "tests/boards/stm32f405/firmware/support.hpp"

extern std::uint32_t data_source, data_begin, data_end, bss_begin, bss_end, stack_top;

namespace {

alignas(512) Handler vectors[16 + 82];

[[noreturn]] void unexpected() {
  results[0] = 0xBAD00000 | (word(0xE000ED04) & 0x1FF);
  for (;;) wait_for_interrupt();
}

}  // namespace

extern "C" [[noreturn]] void reset_handler() {
  word(0xE000ED88) = 0xF << 20;  // enables the FPU before its first use
  for (std::uint32_t *from = &data_source, *to = &data_begin; to < &data_end;) *to++ = *from++;
  for (std::uint32_t* to = &bss_begin; to < &bss_end;) *to++ = 0;
  for (auto& vector : vectors) vector = unexpected;
  word(0xE000ED08) = reinterpret_cast<std::uint32_t>(vectors);
  run();
  for (;;) wait_for_interrupt();
}

struct FlashVectors {
  std::uint32_t* stack;
  void (*reset)();
};
extern const FlashVectors flash_vectors;
[[gnu::section(".vectors"), gnu::used]] const FlashVectors flash_vectors{&stack_top, reset_handler};

void set_handler(unsigned exception, Handler handler) { vectors[exception] = handler; }

void enable_interrupt(unsigned position, unsigned priority) {
  byte(0xE000E400 + position) = static_cast<std::uint8_t>(priority << 4);
  word(0xE000E100 + position / 32 * 4) = 1u << position % 32;
}

void run_at_168_MHz() {
  word(0x40023C00) = 5 | 7 << 8;  // FLASH_ACR: 5 wait states, caches
  word(rcc::cr) |= 1u << 16;
  while ((word(rcc::cr) & 1u << 17) == 0) {
  }
  word(rcc::pllcfgr) = 4 | 168 << 6 | 0 << 16 | 1 << 22 | 7 << 24;
  word(rcc::cr) |= 1u << 24;
  while ((word(rcc::cr) & 1u << 25) == 0) {
  }
  word(rcc::cfgr) = 5 << 10 | 4 << 13;
  word(rcc::cfgr) = word(rcc::cfgr) | 2;
  while ((word(rcc::cfgr) & 0xC) != 8) {
  }
}

void start_cycle_counter() {
  word(0xE000EDFC) = 1u << 24;
  word(0xE0001004) = 0;
  word(0xE0001000) = 1;
}

void gpio::alternate(std::uint32_t port, unsigned pin, unsigned function) {
  const std::uint32_t afr = port + (pin < 8 ? afrl : afrh);
  word(afr) = (word(afr) & ~(0xFu << 4 * (pin % 8))) | function << 4 * (pin % 8);
  word(port + moder) = (word(port + moder) & ~(3u << 2 * pin)) | 2u << 2 * pin;
}

namespace adc {
namespace {
constexpr std::uint32_t dma2 = 0x40026400, common_data = 0x40012308;
}

void collect_common_data(std::uint32_t size, std::uint32_t items, volatile std::uint32_t* to) {
  word(dma2 + 0x10) = 0;
  word(dma2 + 0x08) = 0x3D;  // flags of the previous run
  word(dma2 + 0x18) = common_data;
  word(dma2 + 0x1C) = reinterpret_cast<std::uint32_t>(to);
  word(dma2 + 0x14) = items;
  word(dma2 + 0x10) = 1 << 10 | size << 11 | size << 13 | 1;
}
std::uint32_t items_left() { return word(dma2 + 0x14); }
void wait_for_items() {
  for (unsigned i = 0; i < 10'000 && (word(dma2) & 1 << 5) == 0; ++i) {
  }
}
}  // namespace adc

void watchdog::start() {
  constexpr std::uint32_t kr = 0x40003000, pr = 0x40003004, rlr = 0x40003008;
  word(kr) = 0xCCCC;
  word(kr) = 0x5555;
  word(pr) = 0;
  word(rlr) = 499;
  word(kr) = 0xAAAA;
}

void remap_sram1() {
  word(rcc::apb2enr) |= 1u << 14;  // SYSCFG
  [[maybe_unused]] const std::uint32_t clock = word(rcc::apb2enr);
  word(0x4001'3800) = 3;
  asm volatile("dsb\n isb" ::: "memory");
}
