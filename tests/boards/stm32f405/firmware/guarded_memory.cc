// Access checks with the firmware's memory protection. Each probe records the CFSR bits, or 0 if it passed.
#include "firmware/drivers/memory_protection.cpp"

#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t cfsr = 0xE000'ED28, hfsr = 0xE000'ED2C;

volatile std::uint32_t status = 0;

extern "C" void note_refusal(std::uint32_t* frame) {
  status = word(cfsr);
  word(cfsr) = 0xFFFFFFFF;
  word(hfsr) = 0xFFFFFFFF;
  frame[6] = frame[5] & ~1u;  // a probe that faults returns to its caller
}
[[gnu::naked]] void refusal() { asm volatile("mrs r0, msp\n b note_refusal"); }

[[gnu::naked, gnu::noinline]] void load_word(std::uint32_t) { asm volatile("ldr r0, [r0]\n bx lr"); }
[[gnu::naked, gnu::noinline]] void store_word(std::uint32_t) { asm volatile("str r0, [r0]\n bx lr"); }
[[gnu::naked, gnu::noinline]] void run_at(std::uint32_t) { asm volatile("orr r0, #1\n bx r0"); }

constexpr unsigned probes = 23;
std::uint32_t verdicts[probes], verdict_count = 0;
void note(void (*probe)(std::uint32_t), std::uint32_t address) {
  status = 0;
  probe(address);
  verdicts[verdict_count++] = status;
}

[[gnu::noinline]] void probe_all() {
  constexpr std::uint32_t code_in_sram = 0x2001'4100, remapped_code = code_in_sram - 0x2000'0000,
                          data_in_sram = 0x2001'0000, data_in_sram2 = 0x2001'C000, core_coupled = 0x1000'8000;
  constexpr std::uint16_t return_to_caller = 0x4770;
  word(rcc::ahb1enr) |= 1;
  half(code_in_sram) = return_to_caller;
  half(data_in_sram2) = return_to_caller;
  half(data_in_sram) = return_to_caller;
  set_handler(3, refusal);
  remap_sram1();
  inkwell::drivers::protect_memory();

  // results[1] to [9]: accesses that the firmware needs.
  note(load_word, 0x0800'0000);
  note(load_word, 0x080F'FFFC);
  note(load_word, data_in_sram + 4);
  note(store_word, data_in_sram + 4);
  note(store_word, data_in_sram2 + 4);
  note(run_at, remapped_code);
  note(load_word, remapped_code);
  note(store_word, core_coupled);
  note(load_word, gpio::a);
  // results[10] to [23]: accesses that the firmware never makes.
  note(load_word, 0);
  note(store_word, 8);
  note(run_at, 0);
  note(store_word, 0x0801'8000);
  note(load_word, 0x0810'0000);
  note(store_word, remapped_code);
  note(load_word, 0x0001'3FFC);
  note(load_word, 0x0001'C000);
  note(load_word, code_in_sram);
  note(run_at, code_in_sram);
  note(run_at, data_in_sram);
  note(run_at, data_in_sram2);
  note(load_word, 0x2200'0000);
  note(store_word, 0x2200'0004);

  for (std::uint32_t i = 0; i < verdict_count; ++i) results[1 + i] = verdicts[i];
  results[0] = finished;
}

}  // namespace

void run() {
  asm volatile("msr msp, %0" ::"r"(0x2001'3000));  // below the interrupt code of the firmware
  probe_all();
  for (;;) wait_for_interrupt();
}
