// One CPU fault of each kind in sequence. Each record contains CFSR, HFSR, BFAR, and whether the stacked program
// counter is that of the faulting instruction.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

std::uint32_t record = 0;
std::uint32_t resume_at = 0, expected = 0;

extern "C" void note_cpu_fault(std::uint32_t* frame) {
  const std::uint32_t index = 4 + 4 * record++;
  results[index] = word(0xE000ED28);
  results[index + 1] = word(0xE000ED2C);
  results[index + 2] = word(0xE000ED38);
  results[index + 3] = frame[6] - expected;
  word(0xE000ED28) = 0xFFFFFFFF;
  word(0xE000ED2C) = 0xFFFFFFFF;
  frame[6] = resume_at;
}
[[gnu::naked]] void cpu_fault() { asm volatile("mov r0, sp\n push {r4, lr}\n bl note_cpu_fault\n pop {r4, pc}"); }

// Records the address of the instruction and of the continuation, then executes the instruction.
#define FAULTING(instruction, input)                                                                      \
  asm volatile("adr r3, 1f\n str r3, [%0]\n adr r3, 2f\n str r3, [%1]\n b 1f\n .align 2\n1: " instruction \
               "\n nop\n .align 2\n2:" ::"r"(&expected),                                                  \
               "r"(&resume_at), "r"(input)                                                                \
               : "r3", "memory")

}  // namespace

void run() {
  set_handler(3, cpu_fault);
  set_handler(5, cpu_fault);
  set_handler(6, cpu_fault);
  FAULTING("ldr r3, [%2]", 0x60000000);  // unmapped address, escalates
  word(0xE000ED24) = 7 << 16;            // enables MemManage, BusFault and UsageFault
  FAULTING("str r3, [%2]", 0x2F000000);
  FAULTING("udf #0", 0);
  results[0] = finished;
  // Without an executable handler, a CPU fault inside HardFault locks up the core.
  set_handler(3, [] { word(0x60000000) = 0; });
  word(0xE000ED24) = 0;
  word(0x60000000) = 0;
}
