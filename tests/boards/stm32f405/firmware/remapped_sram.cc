// SRAM1 at address 0: data, code, changed code, and the return of the flash after a reset.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t offset = 0x1'4000, at_own_address = 0x2000'0000 + offset;
constexpr std::uint16_t return_to_caller = 0x4770;

std::uint32_t call(std::uint32_t address) {
  asm volatile("dsb\n isb" ::: "memory");
  return reinterpret_cast<std::uint32_t (*)()>(address | 1)();
}

/// Writes a function that returns `value` to the address `target`.
void write_function(std::uint32_t target, std::uint32_t value) {
  half(target) = static_cast<std::uint16_t>(0x2000 | value);  // movs r0, #value
  half(target + 2) = return_to_caller;
}

/// Returns the cycles of the second call of a function with 20 additions and a return.
std::uint32_t cycles_of_additions(std::uint32_t address) {
  call(address);
  const std::uint32_t before = cycles();
  call(address);
  return cycles() - before;
}

}  // namespace

void run() {
  // The flash is at address 0 after a reset. A word of SRAM2 counts the runs.
  results[8 + results[15]] = word(0) == word(0x0800'0000);
  const bool is_first_run = results[15] == 0;
  results[15] = 1;
  if (!is_first_run) {
    results[0] = finished;
    for (;;) wait_for_interrupt();
  }
  start_cycle_counter();
  word(at_own_address) = 0x1234'5678;
  remap_sram1();
  results[1] = word(offset) == 0x1234'5678;
  word(offset + 4) = 0x8765'4321;
  results[2] = word(at_own_address + 4) == 0x8765'4321;
  // Each bit shows a call of old instructions.
  std::uint32_t wrong = 0;
  for (std::uint32_t value = 0; value < 100; ++value) {
    write_function(at_own_address, value);
    if (call(offset) != value) wrong |= 1;
    if (call(at_own_address) != value) wrong |= 2;
    write_function(offset, 200 - value);
    if (call(offset) != 200 - value) wrong |= 4;
    if (call(at_own_address) != 200 - value) wrong |= 8;
    write_function(offset, value);
    if (call(at_own_address) != value) wrong |= 16;
    word(0x2200'0000 + 32 * (at_own_address - 0x2000'0000)) = ~value & 1;  // changes the lowest bit of the instruction
    if (call(offset) != (value ^ 1)) wrong |= 32;
    if (call(at_own_address) != (value ^ 1)) wrong |= 64;
  }
  results[3] = wrong;
  // At address 0, a fetch does not cross the system bus.
  for (std::uint32_t i = 0; i < 20; ++i) half(at_own_address + 2 * i) = 0x3001;  // adds r0, #1
  half(at_own_address + 40) = return_to_caller;
  results[4] = cycles_of_additions(at_own_address);
  results[5] = cycles_of_additions(offset);
  word(0xE000ED0C) = 0x05FA'0004;  // SYSRESETREQ
  for (;;) {
  }
}
