// Accesses that fault because of alignment or the memory protection unit, and a fault inside an IT block. Each access
// writes a record from results[4] on. A record contains CFSR, the valid fault address register, the offset of the
// stacked program counter from the instruction, and the stacked IT bits.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t ccr = 0xE000ED14, shcsr = 0xE000ED24, cfsr = 0xE000ED28, mmfar = 0xE000ED34, bfar = 0xE000ED38,
                        mpu_control = 0xE000ED94, mpu_base = mpu_control + 8, mpu_attributes = mpu_control + 12;
std::uint32_t records = 0, resume_at = 0, expected = 0;
volatile std::uint32_t words[8] = {0x33221100, 0x77665544, 0xBBAA9988, 0xFFEEDDCC};

extern "C" void note_access(std::uint32_t* frame) {
  const std::uint32_t bits = word(cfsr), index = 4 + 4 * records++;
  results[index] = bits;
  results[index + 1] = (bits & 0x80) != 0 ? word(mmfar) : (bits & 0x8000) != 0 ? word(bfar) : 0;
  results[index + 2] = frame[6] - expected;
  results[index + 3] = frame[7] & 0x0600FC00;
  word(cfsr) = bits;
  if (resume_at != 0) frame[6] = resume_at, frame[7] &= ~0x0600FC00u;
}
// The first instruction would be skipped if the IT state of the faulting code were still active.
[[gnu::naked]] void cpu_fault() { asm volatile("mov r0, sp\n push {r4, lr}\n bl note_access\n pop {r4, pc}"); }

// Records the address of the instruction and of the continuation, then executes the instruction.
#define FAULTING(instruction, input)                                                                      \
  asm volatile("adr r3, 1f\n str r3, [%0]\n adr r3, 2f\n str r3, [%1]\n b 1f\n .align 2\n1: " instruction \
               "\n nop\n .align 2\n2:" ::"r"(&expected),                                                  \
               "r"(&resume_at), "r"(input)                                                                \
               : "r3", "r4", "s0", "memory")

/// The third instruction of the block reads an unmapped address. The CPU fault handler changes the address to the first
/// word of the flash.
[[gnu::naked, gnu::noinline]] std::uint32_t cpu_fault_in_block(std::uint32_t*) {
  asm volatile(
      "adr r3, 1f\n str r3, [r0]\n movs r1, #0\n mov r0, #0x60000000\n cmp r1, #0\n b 2f\n .balign 4\n"
      "2: itete eq\n addeq r1, #1\n addne.w r1, r1, #64\n"
      "1: ldreq.w r3, [r0]\n addne r1, #128\n it eq\n addeq r1, r1, r3\n"
      "mov r0, r1\n bx lr");
}
extern "C" void mend_source(std::uint32_t* frame) {
  resume_at = 0;
  note_access(frame);
  frame[0] = 0;
}
[[gnu::naked]] void mended_cpu_fault() { asm volatile("mov r0, sp\n push {r4, lr}\n bl mend_source\n pop {r4, pc}"); }

}  // namespace

void run() {
  for (unsigned exception = 3; exception <= 6; ++exception) set_handler(exception, cpu_fault);
  word(shcsr) = 7 << 16;
  const auto odd = reinterpret_cast<std::uint32_t>(words) + 2;
  results[1] = word(odd);               // a single word may be unaligned
  FAULTING("ldmia %2, {r3, r4}", odd);  // records 0 to 6: multiple words and FPU accesses must be aligned
  FAULTING("ldrd r3, r4, [%2]", odd);
  FAULTING("strd r3, r4, [%2]", odd);
  FAULTING("ldrex r3, [%2]", odd);
  FAULTING("vldr s0, [%2]", odd);
  FAULTING("vstr s0, [%2]", odd);
  FAULTING("stmia %2, {r3, r4}", odd);
  word(ccr) |= 1 << 3;
  asm volatile("dsb\n isb" ::: "memory");
  FAULTING("ldr r3, [%2]", odd);  // 7, 8
  FAULTING("strh r3, [%2]", odd - 1);
  results[2] = half(odd);
  word(ccr) &= ~(1u << 3);
  asm volatile("dsb\n isb" ::: "memory");
  results[3] = word(odd);
  FAULTING("ldr r3, [%2]", 0x60000000);  // 9: unmapped address in the middle of a block of instructions

  // Region 1: 32 read-only bytes in the middle of `guarded`. The default map applies elsewhere.
  alignas(64) static volatile std::uint32_t guarded[16];
  word(mpu_base) = (reinterpret_cast<std::uint32_t>(guarded) + 32) | 1 << 4 | 1;
  word(mpu_attributes) = 5u << 24 | 4 << 1 | 1;
  word(mpu_control) = 1 | 1 << 2;
  asm volatile("dsb\n isb" ::: "memory");
  guarded[7] = 7;
  results[100] = guarded[8] + guarded[7];
  FAULTING("str r3, [%2]", &guarded[8]);  // 10
  // Region 2: no execution at the end of SRAM.
  word(mpu_base) = 0x20010000 | 1 << 4 | 2;
  word(mpu_attributes) = 1u << 28 | 3u << 24 | 14 << 1 | 1;
  half(0x20010000) = 0x4770;  // BX LR
  asm volatile("dsb\n isb" ::: "memory");
  FAULTING("mov r4, lr\n bx %2", 0x20010001);  // 11
  word(mpu_control) = 0;
  asm volatile("dsb\n isb" ::: "memory");
  guarded[8] = 8;
  results[101] = guarded[8];

  set_handler(5, mended_cpu_fault);
  results[102] = cpu_fault_in_block(&expected) - word(0);  // 12
  set_handler(5, cpu_fault);
  constexpr std::uint32_t gpio_a_inputs = gpio::a + gpio::idr;
  word(rcc::ahb1enr) |= 1;
  FAULTING("ldr r3, [%2]", gpio_a_inputs - 2);  // 13 to 17: registers, independent of CCR
  FAULTING("ldrh r3, [%2]", gpio_a_inputs + 1);
  FAULTING("str r3, [%2]", gpio::a + gpio::odr + 1);
  FAULTING("strh r3, [%2]", gpio::a + gpio::odr + 3);
  FAULTING("ldr r3, [%2]", cfsr + 2);
  half(gpio::a + gpio::odr) = 0x1234;
  results[103] = byte(gpio::a + gpio::odr + 1) | word(gpio::a + gpio::odr) << 16;
  results[0] = finished;
}
