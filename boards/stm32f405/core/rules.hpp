// Rules for firmware. The virtual chip tolerates violations of these rules, but real hardware does not.
//
// Each row of INKWELL_CHIP_RULES is one rule. A model that detects a violation reports the rule and, if necessary, the
// affected peripheral or pin.
#pragma once

// To add a rule, first add a row to INKWELL_CHIP_RULES.
// In the model, call violate(Rule::NAME) when firmware breaks the rule, and emulate the effect on real hardware.
// In tests/boards/stm32f405, add a test to violations_test.cpp with its number in firmware/rules.cc.
// The test firmware must break only the new rule.
//
// `virtual-board --strict` exits at the first broken rule. System tests and `inkwell experiment` use `--strict`.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include "boards/stm32f405/core/interfaces.hpp"

namespace inkwell::virtual_board {

/// RULE(name, register, section, action, consequence on real hardware, remedy)
#define INKWELL_CHIP_RULES(RULE)                                                                                       \
  RULE(float_unit_off, "CPACR", "PM0214, Enabling the FPU", "An FPU instruction is executed while the FPU is off",     \
       "the instruction raises a UsageFault (NOCP)",                                                                   \
       "before the first FPU instruction, write CPACR |= 0xF << 20, then execute DSB and ISB")                         \
  RULE(stack_outside_memory, "MSP", "RM0090, Memory map", "The stack is outside of SRAM and CCM",                      \
       "the first push raises a BusFault",                                                                             \
       "set the initial stack pointer to at most 0x20020000 (SRAM) or 0x10010000 (CCM)")                               \
  RULE(region_undefined, "MPU_RASR", "PM0214, MPU region attribute and size register",                                 \
       "An enabled MPU region has reserved attributes, or its base address is not a multiple of its size",             \
       "the protection is undefined; the model rounds the base address down",                                          \
       "align the base address; use SIZE 4 or more, SRD only from 256 bytes on, and no reserved AP, TEX, C and B")     \
  RULE(region_number, "MPU_RNR", "PM0214, MPU region number register", "An MPU region number above 7 is selected",     \
       "the selected region is undefined; the model uses the number modulo 8", "use region numbers 0 to 7")            \
  RULE(narrow_core_write, "", "ARMv7-M, B3.1.1 and B3.2", "A core register is written with fewer than 32 bits",        \
       "the effect is undefined; in the model the other bits do not change",                                           \
       "write whole words; only SHPR, CFSR, NVIC_IPR and the ITM stimulus ports accept fewer bits")                    \
  RULE(core_reset, "AIRCR", "PM0214, Application interrupt and reset control register", "VECTRESET is set",            \
       "only the core is reset: SYSCFG_MEMRMP and all peripherals keep their state; the model ignores the bit",        \
       "write VECTRESET as 0 and set SYSRESETREQ")                                                                     \
  RULE(flash_wait_states, "FLASH_ACR", "RM0090, Relation between CPU clock frequency and Flash memory read time",      \
       "LATENCY is too small for HCLK",                                                                                \
       "flash reads return wrong data; in the model the next instruction from flash is undefined",                     \
       "before switching the clock, set LATENCY: at 3.3 V, one wait state for each 30 MHz above the first 30 MHz")     \
  RULE(voltage_scale, "PWR_CR", "RM0090, PWR power control register", "HCLK is above 144 MHz at voltage scale 2",      \
       "the core fails", "set VOS before switching the clock")                                                         \
  RULE(hclk_too_fast, "RCC_CFGR", "RM0090, Clocks", "HCLK is above 168 MHz", "the core fails",                         \
       "increase the divider PLLP or HPRE")                                                                            \
  RULE(pclk1_too_fast, "RCC_CFGR", "RM0090, Clocks", "PCLK1 is above 42 MHz", "APB1 peripherals fail",                 \
       "set PPRE1 before switching the clock")                                                                         \
  RULE(pclk2_too_fast, "RCC_CFGR", "RM0090, Clocks", "PCLK2 is above 84 MHz", "APB2 peripherals fail",                 \
       "set PPRE2 before switching the clock")                                                                         \
  RULE(pll_input, "RCC_PLLCFGR", "RM0090, RCC PLL configuration register",                                             \
       "The PLL input frequency is outside 1 to 2 MHz", "the PLL does not lock, or its output has jitter",             \
       "set PLLM so that the oscillator frequency divided by PLLM is 1 to 2 MHz")                                      \
  RULE(pll_output, "RCC_PLLCFGR", "RM0090, RCC PLL configuration register",                                            \
       "The PLL VCO frequency is outside 100 to 432 MHz", "the PLL does not lock", "correct PLLN")                     \
  RULE(pll_written_while_on, "RCC_PLLCFGR", "RM0090, PLL configuration", "RCC_PLLCFGR is written while the PLL is on", \
       "the write is ignored", "switch the system clock to another source, then switch the PLL off before the write")  \
  RULE(clock_off, "RCC_xxxENR", "RM0090, Peripheral clock enable register",                                            \
       "A peripheral is used while its clock is off", "the peripheral reads 0 and ignores writes",                     \
       "set the clock enable bit first")                                                                               \
  RULE(clock_fresh, "RCC_xxxENR", "ES0182, Delay after an RCC peripheral clock enabling",                              \
       "A peripheral is used before its clock has started", "the access is lost",                                      \
       "after writing the enable register, read the register back")                                                    \
  RULE(ccm_clock_off, "RCC_AHB1ENR", "RM0090, RCC AHB1 peripheral clock enable register",                              \
       "CCM is used while CCMDATARAMEN is 0", "the access raises a BusFault",                                          \
       "set CCMDATARAMEN before the first push, because a boot loader may have cleared the bit")                       \
  RULE(converter_too_fast, "ADC_CCR", "STM32F405 data sheet, ADC characteristics", "The ADC clock is above 36 MHz",    \
       "conversions are wrong", "increase ADCPRE")                                                                     \
  RULE(converter_not_stable, "ADC_CR2", "STM32F405 data sheet, ADC characteristics",                                   \
       "A conversion starts less than 3 us after ADON is set", "the result is wrong", "wait 3 us")                     \
  RULE(reference_off, "ADC_CCR", "RM0090, Temperature sensor",                                                         \
       "The temperature sensor or the internal reference is converted while TSVREFE is 0", "the result is invalid",    \
       "set TSVREFE first")                                                                                            \
  RULE(reference_hurried, "ADC_SMPR1", "STM32F405 data sheet, Embedded internal reference voltage",                    \
       "The temperature sensor or the internal reference is sampled for less than 10 us, or less than 10 us after "    \
       "TSVREFE is set",                                                                                               \
       "the result is wrong", "set SMP16 or SMP17 to at least 10 us, and wait 10 us after setting TSVREFE")            \
  RULE(analog_pin_mode, "GPIOx_MODER", "RM0090, Analog configuration",                                                 \
       "The ADC samples a pin that is not in analog mode",                                                             \
       "the pull resistors and the input stage falsify the result", "set MODER to 0b11")                               \
  RULE(timer_locked, "TIMx_BDTR", "RM0090, TIM1 and TIM8 break and dead-time register",                                \
       "A write would change bits that LOCK protects", "the bits do not change",                                       \
       "configure the timer before setting LOCK")                                                                      \
  RULE(watchdog_busy, "IWDG_SR", "RM0090, IWDG status register",                                                       \
       "IWDG_PR or IWDG_RLR is written while PVU or RVU is set", "the written value is lost",                          \
       "wait until the flag is 0")                                                                                     \
  RULE(copy_by_first_controller, "DMA_SxCR", "RM0090, DMA main features",                                              \
       "A memory-to-memory transfer is requested from DMA1", "DMA1 transfers nothing", "use DMA2")                     \
  RULE(usart_pin, "GPIOx_AFRx", "STM32F405 data sheet, Alternate function mapping",                                    \
       "A USART transmits while no pin is set to its TX function", "no pin carries the signal",                        \
       "set a TX pin to the alternate function")                                                                       \
  RULE(usart_divider, "USART_BRR", "RM0090, Fractional baud rate generation",                                          \
       "A USART transmits with a divider below 16, or below 8 with OVER8", "the transmitted signal is invalid",        \
       "set BRR first")                                                                                                \
  RULE(stream_flags_left, "DMA_SxCR", "RM0090, DMA stream configuration procedure",                                    \
       "A DMA stream is enabled while flags of its previous transfer are set", "the new transfer may not start",       \
       "clear all flags of the stream with DMA_LIFCR or DMA_HIFCR first")                                              \
  RULE(option_bytes_locked, "FLASH_OPTCR", "RM0090, Unlocking the option bytes",                                       \
       "FLASH_OPTCR is written while OPTLOCK is set, or unlocked with a wrong key",                                    \
       "the write is ignored; a wrong key locks FLASH_OPTCR until reset",                                              \
       "write 0x08192A3B and 0x4C5D6E7F to FLASH_OPTKEYR first")                                                       \
  RULE(narrow_register_write, "", "RM0090, AHB/APB bridges; register map of the peripheral",                           \
       "A register is written with fewer bits than the peripheral accepts",                                            \
       "the bridge repeats the bytes in the whole word",                                                               \
       "write whole words, or half-words where the manual allows them")                                                \
  RULE(usb_clock, "RCC_PLLCFGR", "RM0090, OTG_FS main features; USB 2.0, 7.1.11",                                      \
       "The USB core is attached with a clock that is not within 0.25 % of 48 MHz", "the host receives nothing",       \
       "derive 48 MHz from the crystal with PLLQ")                                                                     \
  RULE(usb_pins, "GPIOA_AFRH", "RM0090, I/O pin alternate function multiplexer",                                       \
       "The USB core is attached while PA11 or PA12 is not in alternate function 10", "the host detects no device",    \
       "set both pins to alternate function 10")                                                                       \
  RULE(usb_pull_up_unpowered, "OTG_FS_DCTL", "USB 2.0, 7.1.5", "D+ is pulled up while the cable supplies no VBUS",     \
       "the device feeds current into a bus without power", "detect VBUS, and set SDIS while VBUS is absent")          \
  RULE(usb_transceiver, "OTG_FS_GUSBCFG", "RM0090, OTG_FS core initialization",                                        \
       "The USB core is attached while PHYSEL is 0", "it is undefined which transceiver the core drives",              \
       "set PHYSEL first")                                                                                             \
  RULE(usb_core_reset, "OTG_FS_GRSTCTL", "RM0090, OTG_FS reset register",                                              \
       "The USB core is attached without a core reset (CSRST) after PHYSEL was set",                                   \
       "the core retains states of another transceiver", "reset the core after selecting the transceiver")             \
  RULE(usb_mode, "OTG_FS_GUSBCFG", "RM0090, ID line detection",                                                        \
       "The USB core is attached as a device with neither FDMOD nor the ID pin PA10", "the core may be in host mode",  \
       "set FDMOD, or set PA10 to alternate function 10")                                                              \
  RULE(usb_mode_wait, "OTG_FS_GUSBCFG", "RM0090, OTG_FS USB configuration register",                                   \
       "A device mode register is written less than 25 ms after FDMOD is set", "the mode may not have changed yet",    \
       "wait 25 ms")                                                                                                   \
  RULE(usb_speed, "OTG_FS_DCFG", "RM0090, OTG_FS device configuration register",                                       \
       "The USB core is attached with DSPD other than 3",                                                              \
       "the other values are reserved, because the core supports only full speed", "set DSPD to 3")                    \
  RULE(usb_turnaround, "OTG_FS_GUSBCFG", "RM0090, TRDT values",                                                        \
       "The USB core is attached with TRDT too small for HCLK", "the answers of the device are corrupted",             \
       "set TRDT from the table: 6 from 32 MHz on, more below 32 MHz")                                                 \
  RULE(usb_narrow_access, "OTG_FS", "RM0090, OTG_FS control and status registers",                                     \
       "A USB register is accessed with fewer than 32 bits", "the effect is undefined", "access whole words")          \
  RULE(usb_endpoint_type, "OTG_FS_DIEPCTLx", "RM0090, OTG device endpoint x control register",                         \
       "A transfer starts on an endpoint other than 0 whose EPTYP is control",                                         \
       "only endpoint 0 can be a control endpoint", "write EPTYP together with USBAEP")                                \
  RULE(usb_no_such_fifo, "OTG_FS_GRSTCTL", "RM0090, OTG_FS reset register",                                            \
       "A transmit FIFO that does not exist is flushed", "TXFFLSH may stay set",                                       \
       "use TXFNUM 0 to 3, or 16 for all FIFOs")                                                                       \
  RULE(usb_size_while_enabled, "OTG_FS_DIEPTSIZx", "RM0090, OTG device IN endpoint x transfer size register",          \
       "The size of a transfer is changed while its IN endpoint is enabled", "the transfer is corrupted",              \
       "wait for XFRC, or disable the endpoint first")                                                                 \
  RULE(usb_out_size_while_enabled, "OTG_FS_DOEPTSIZx", "RM0090, OTG device OUT endpoint x transfer size register",     \
       "The size of a transfer is changed while its OUT endpoint is enabled", "the transfer is corrupted",             \
       "wait for XFRC, or disable the endpoint first")                                                                 \
  RULE(usb_flush_in_use, "OTG_FS_GRSTCTL", "RM0090, OTG_FS reset register",                                            \
       "A FIFO is flushed while the core may be using it", "packets in the FIFO are corrupted",                        \
       "first wait until NAK is effective for the endpoint or for all endpoints")                                      \
  RULE(usb_disturbed, "OTG_FS_GRSTCTL", "RM0090, OTG_FS reset register; IN endpoint disable",                          \
       "A USB register is written while the core is busy with a related operation", "the result of both is undefined", \
       "wait until CSRST, RXFFLSH or TXFFLSH is 0 or EPDISD is 1, and 3 PHY clocks after CSRST")                       \
  RULE(usb_disable_without_enable, "OTG_FS_DIEPCTLx", "RM0090, IN endpoint disable",                                   \
       "EPDIS is set for an IN endpoint that is not enabled", "EPDIS has no effect, and EPDISD is not set",            \
       "check EPENA first")                                                                                            \
  RULE(usb_no_packets, "OTG_FS_DxEPTSIZx", "RM0090, OTG_FS device programming model",                                  \
       "An endpoint is enabled with a packet count of 0", "the transfer never completes", "write PKTCNT first")        \
  RULE(usb_bytes_beyond_packets, "OTG_FS_DIEPTSIZx", "RM0090, OTG device IN endpoint x transfer size register",        \
       "An IN transfer has more bytes than its packets can contain", "the transfer ends early",                        \
       "set PKTCNT according to XFRSIZ and MPSIZ")                                                                     \
  RULE(usb_inactive_endpoint, "OTG_FS_DxEPCTLx", "RM0090, USB endpoint activation",                                    \
       "An endpoint is enabled while it is not active in this configuration", "the host receives no answer",           \
       "set USBAEP")                                                                                                   \
  RULE(usb_stale_words, "OTG_FS_GRSTCTL", "RM0090, Operations of IN data transfers",                                   \
       "An IN endpoint is enabled while its FIFO contains words of an earlier transfer",                               \
       "the host receives the old words", "flush the FIFO")                                                            \
  RULE(usb_fifo_too_small, "OTG_FS_DIEPTXFx", "RM0090, Peripheral FIFO architecture",                                  \
       "A packet of the transfer is larger than the transmit FIFO", "the packet is never sent", "enlarge the FIFO")    \
  RULE(usb_interleaved, "OTG_FS", "ES0182, Transmit data FIFO is corrupted when the write sequence is interrupted",    \
       "The FIFO writes of a packet are interleaved with other accesses, which damages the packet",                    \
       "the packet is sent with a bad CRC until the FIFO is flushed",                                                  \
       "write each packet without interruption, with interrupts disabled")                                             \
  RULE(usb_fifo_packets, "OTG_FS_DIEPTXFx", "RM0090, IN endpoint data transfer",                                       \
       "A transmit FIFO contains more than eight packets",                                                             \
       "the endpoint hangs, because its packet counter has three bits", "limit the FIFO to eight packets")             \
  RULE(usb_fifo_full, "OTG_FS_DTXFSTSx", "RM0090, OTG device IN endpoint transmit FIFO status register",               \
       "A word is written to a full transmit FIFO and is lost", "the packet lacks this word", "check DTXFSTS first")   \
  RULE(usb_fifo_before_enable, "OTG_FS_DIEPCTLx", "RM0090, Operations of IN data transfers",                           \
       "The FIFO of an IN endpoint is written before the endpoint is enabled", "FIFO words and transfer do not match", \
       "set EPENA and CNAK first")                                                                                     \
  RULE(usb_words_beyond_transfer, "OTG_FS_DIEPTSIZx", "RM0090, Operations of IN data transfers",                       \
       "More words are written to a transmit FIFO than the transfer contains",                                         \
       "the surplus words are sent with the next transfer", "write only the number of bytes in XFRSIZ")                \
  RULE(usb_memory_exceeded, "OTG_FS_DIEPTXFx", "RM0090, FIFO RAM allocation",                                          \
       "A FIFO extends beyond the 320 words of packet memory", "the FIFO overwrites another FIFO",                     \
       "make the FIFO smaller")                                                                                        \
  RULE(usb_memory_overlap, "OTG_FS_DIEPTXFx", "RM0090, FIFO RAM allocation", "Two FIFOs overlap in packet memory",     \
       "the FIFOs overwrite each other", "start each FIFO at the end of the previous FIFO")                            \
  RULE(usb_out_disable, "OTG_FS_DOEPCTLx", "RM0090, Disabling an OUT endpoint",                                        \
       "EPDIS is set for OUT endpoint 0 or for an OUT endpoint that is not enabled",                                   \
       "EPDIS has no effect, and EPDISD is not set", "check EPENA first")                                              \
  RULE(usb_out_disable_early, "OTG_FS_DOEPCTLx", "RM0090, Disabling an OUT endpoint",                                  \
       "An OUT endpoint is disabled before the global OUT NAK is effective",                                           \
       "packets may be lost; the model waits for the global OUT NAK", "wait for GONAKEFF")                             \
  RULE(usb_out_size, "OTG_FS_DOEPTSIZx", "RM0090, OTG device OUT endpoint x transfer size register",                   \
       "The size of an OUT transfer is not a multiple of the packet size", "a full packet exceeds the transfer",       \
       "round XFRSIZ up to a multiple of MPSIZ")                                                                       \
  RULE(usb_out_overrun, "OTG_FS_DOEPTSIZx", "RM0090, Operations of OUT data transfers",                                \
       "An OUT packet is larger than the rest of its transfer", "there is no space for the surplus bytes",             \
       "round XFRSIZ up to a multiple of MPSIZ")                                                                       \
  RULE(usb_nak_cleared_early, "OTG_FS_DOEPCTL0", "RM0090, SETUP and OUT data transfers",                               \
       "CNAK is written for OUT endpoint 0 before the setup-done word is popped",                                      \
       "the word is lost, and STUP is never set", "pop the setup-done word first")                                     \
  RULE(usb_pop_empty, "OTG_FS_GRXSTSP", "RM0090, Packet read", "GRXSTSP is read while the receive FIFO is empty",      \
       "the value is invalid", "check RXFLVL first")                                                                   \
  RULE(usb_pop_before_data, "OTG_FS_GRXSTSP", "RM0090, Packet read",                                                   \
       "GRXSTSP is read before the data of the previous packet, so that a data word is read as a status word",         \
       "all further words are misread", "read BCNT bytes of data first")                                               \
  RULE(usb_read_beyond_packet, "OTG_FS", "RM0090, Packet read", "The receive FIFO is read beyond the end of a packet", \
       "words of the next packet are lost", "read only BCNT bytes")                                                    \
  RULE(usb_no_room_for_setup, "OTG_FS_GRXFSIZ", "RM0090, Peripheral FIFO architecture",                                \
       "The receive FIFO has no space for a SETUP packet", "the SETUP packet is lost",                                 \
       "reserve ten words for SETUP packets")

enum class Rule : std::uint8_t {
#define INKWELL_RULE(name, ...) name,
  INKWELL_CHIP_RULES(INKWELL_RULE)
#undef INKWELL_RULE
};

struct RuleInfo {
  std::string_view name;
  std::string_view of_register;  ///< register with the wrong value, or register to be written first
  std::string_view section;
  std::string_view done, consequence, remedy;
};

inline constexpr std::array rules{
#define INKWELL_RULE(name, ...) RuleInfo{#name, __VA_ARGS__},
    INKWELL_CHIP_RULES(INKWELL_RULE)
#undef INKWELL_RULE
};

constexpr const RuleInfo& info(Rule rule) { return rules[static_cast<std::size_t>(rule)]; }

struct Violation {
  Rule rule;
  std::string where;           ///< affected peripheral or pin; may be empty
  std::uint32_t code_address;  ///< instruction (fast mode: block) of the first occurrence
  Ticks first;
  std::uint64_t count = 1;
};

/// Describes the violation in one sentence: action, location, consequence and remedy.
std::string sentence(const Violation& violation);

/// Receives detected violations.
class RuleKeeper {
 public:
  virtual ~RuleKeeper() = default;
  virtual void violate(Rule rule, const std::string& where = {}) = 0;
};

/// Chip interfaces for external peripheral models.
struct ChipConnections {
  Scheduler& scheduler;
  InterruptController& interrupts;
  UnmodelledLog& log;
  RuleKeeper& rules;
  const ChipState& state;
  TriggerLines& triggers;
};

}  // namespace inkwell::virtual_board
