#include "boards/stm32f405/wiring/boot_loader.hpp"

#include <cstddef>
#include <cstring>

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t loader_stack = sram_base + 0x2000;

/// The main loop of the loader requests and executes orders.
constexpr std::uint16_t hands[] = {
    0xF240, 0x1001,  // ask: movw r0, #semihosting_poll_order
    0xBEAB,          // bkpt 0xAB
    0x4C0E,          // ldr r4, =FLASH_SR
    0x2801,          // cmp r0, #store
    0xD008,          // beq store
    0x2802,          // cmp r0, #program
    0xD00B,          // beq program
    0x2803,          // cmp r0, #go
    0xD013,          // beq go
    0xF44F, 0x70FA,  // mov r0, #500: 0.1 ms
    0x3801,          // subs r0, #1
    0xD1FD,          // bne, one back
    0xE7F0,          // b ask
    0x600A,          // store: str r2, [r1]
    0x6825,          // ldr r5, [r4]
    0x03ED,          // lsls r5, r5, #15: BSY
    0xD4FC,          // bmi, two back
    0xE7EB,          // b ask
    0xF852, 0x5B04,  // program: ldr r5, [r2], #4
    0xF841, 0x5B04,  // str r5, [r1], #4
    0x6825,          // ldr r5, [r4]
    0x03ED,          // lsls r5, r5, #15: BSY
    0xD4FC,          // bmi, two back
    0x3B01,          // subs r3, #1
    0xD1F6,          // bne program
    0xE7E1,          // b ask
    0x4801,          // go: ldr r0, =loader_go
    0x4700,          // bx r0
};
constexpr std::uint32_t hands_literals[] = {0x4002'3C0C, loader_go + 1};

/// Sets the chip to a state that a real boot loader may leave. The core runs at 60 MHz from the crystal and PLL. The
/// voltage scale is 2, and HSI is off. The CCM clock is off, and VTOR points to the vector table of the boot loader.
/// The clock of the USB PHY is stopped.
constexpr std::uint16_t go[] = {
    0xF643, 0x0000,  // movw r0, #RCC
    0xF2C4, 0x0002,  // movt r0, #RCC
    0x6B41,          // ldr r1, [r0, #AHB2ENR]
    0xF041, 0x0180,  // orr r1, #OTGFSEN
    0x6341,          // str r1, [r0, #AHB2ENR]
    0x6B41,          // ldr r1, [r0, #AHB2ENR]: waits until the clock has started
    0xF640, 0x6300,  // movw r3, #PCGCCTL
    0xF2C5, 0x0300,  // movt r3, #PCGCCTL
    0x2101,          // movs r1, #STPPCLK
    0x6019,          // str r1, [r3]
    0xBF00,          // nop: aligns the constants below
    0x481A,          // ldr r0, =RCC
    0x6C01,          // ldr r1, [r0, #APB1ENR]
    0xF041, 0x5180,  // orr r1, #PWREN
    0x6401,          // str r1, [r0, #APB1ENR]
    0x6C01,          // ldr r1, [r0, #APB1ENR]: waits until the clock has started
    0x4B18,          // ldr r3, =PWR
    0x2100,          // movs r1, #0: VOS
    0x6019,          // str r1, [r3, #CR]
    0x6801,          // ldr r1, [r0, #CR]
    0xF441, 0x3180,  // orr r1, #HSEON
    0x6001,          // str r1, [r0, #CR]
    0x6801,          // ldr r1, [r0, #CR]
    0x038A,          // lsls r2, r1, #14: HSERDY
    0xD5FC,          // bpl, two back
    0x4914,          // ldr r1, =60 MHz
    0x6041,          // str r1, [r0, #PLLCFGR]
    0x6801,          // ldr r1, [r0, #CR]
    0xF041, 0x7180,  // orr r1, #PLLON
    0x6001,          // str r1, [r0, #CR]
    0x6801,          // ldr r1, [r0, #CR]
    0x018A,          // lsls r2, r1, #6: PLLRDY
    0xD5FC,          // bpl, two back
    0x4B11,          // ldr r3, =FLASH
    0x2101,          // movs r1, #1: LATENCY
    0x6019,          // str r1, [r3, #ACR]
    0xF241, 0x0100,  // movw r1, #PPRE1 by 2
    0x6081,          // str r1, [r0, #CFGR]
    0x3102,          // adds r1, #SW from the PLL
    0x6081,          // str r1, [r0, #CFGR]
    0x6881,          // ldr r1, [r0, #CFGR]
    0xF001, 0x010C,  // and r1, #SWS
    0x2908,          // cmp r1, #SWS from the PLL
    0xD1FA,          // bne, three back
    0x6801,          // ldr r1, [r0, #CR]
    0xF021, 0x0101,  // bic r1, #HSION
    0x6001,          // str r1, [r0, #CR]
    0x2100,          // movs r1, #0
    0x6401,          // str r1, [r0, #APB1ENR]
    0x6301,          // str r1, [r0, #AHB1ENR]
    0x4908,          // ldr r1, =VTOR
    0x4A08,          // ldr r2, =the system memory
    0x600A,          // str r2, [r1]
    0xF04F, 0x6100,  // mov r1, #the flash
    0x680A,          // ldr r2, [r1]
    0x4695,          // mov sp, r2
    0x684A,          // ldr r2, [r1, #4]
    0x4710,          // bx r2
};

/// VCO at 240 MHz, divided by 4 for the core and by 5 for USB.
constexpr std::uint32_t pll_for_60_MHz(std::uint32_t crystal_Hz) {
  return crystal_Hz / 1'000'000 | 240 << 6 | 1 << 16 | 1 << 22 | 5 << 24;
}

template <class T, std::size_t n>
std::uint8_t* append(std::uint8_t* to, const T (&words)[n]) {
  std::memcpy(to, words, sizeof words);
  return to + sizeof words;
}

}  // namespace

void put_boot_loader(std::uint8_t* system, std::uint32_t crystal_Hz) {
  const std::uint32_t vectors[] = {loader_stack, loader_entry + 1};
  append(append(append(system, vectors), hands), hands_literals);
  const std::uint32_t literals[] = {0x4002'3800, 0x4000'7000, pll_for_60_MHz(crystal_Hz),
                                    0x4002'3C00, 0xE000'ED08, system_base};
  append(append(system + (loader_go - system_base), go), literals);
}

}  // namespace inkwell::virtual_board
