// Rules for firmware. The virtual chip tolerates violations of these rules, but real hardware does not.
//
// Each rule is a row of the table. A model that detects a violation reports the rule and, if necessary, the affected
// peripheral or pin.
#pragma once

// To add a rule:
// 1. Add a row to INKWELL_CHIP_RULES.
// 2. In the model, call violate(Rule::NAME) at the violation and emulate the effect on silicon.
// 3. In tests/boards/virtual/chip, add a number to firmware/rules.cc and to violations_test.cpp. The test firmware must
//    break only the new rule.
//
// `virtual-board --strict` exits at the first broken rule. System tests and `inkwell experiment` use `--strict`.

#include <array>
#include <chip/interfaces.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace inkwell::virtual_board {

/// RULE(name, register, section, action, consequence on real hardware, remedy)
#define INKWELL_CHIP_RULES(RULE)                                                                                       \
  RULE(float_unit_off, "CPACR", "PM0214, Enabling the FPU", "An instruction of the FPU runs while the FPU is off",     \
       "it is a UsageFault (NOCP)", "write CPACR |= 0xF << 20, then DSB and ISB, before the first one")                \
  RULE(stack_outside_memory, "MSP", "RM0090, Memory map", "The stack does not lie in SRAM or CCM",                     \
       "the first push is a BusFault", "let it begin at or below 0x20020000 (SRAM) or 0x10010000 (CCM)")               \
  RULE(region_undefined, "MPU_RASR", "PM0214, MPU region attribute and size register",                                 \
       "A region of the memory protection unit is enabled that is not at a multiple of its size, or is reserved",      \
       "what it protects is open; here its base is rounded down",                                                      \
       "align it; take SIZE 4 or more, SRD only from 256 bytes on, and no reserved AP, TEX, C and B")                  \
  RULE(region_number, "MPU_RNR", "PM0214, MPU region number register", "A region beyond the eighth is chosen",         \
       "which region is written is left open; here its number is taken modulo 8", "number them from 0 to 7")           \
  RULE(narrow_core_write, "", "ARMv7-M, B3.1.1 and B3.2", "A register of the core is written by fewer than 32 bits",   \
       "what becomes of it is left open; here its other bits stay",                                                    \
       "write whole words; only SHPR, CFSR, NVIC_IPR and the trace's ports take less")                                 \
  RULE(flash_wait_states, "FLASH_ACR", "RM0090, Relation between CPU clock frequency and Flash memory read time",      \
       "LATENCY is too small for HCLK", "the flash is misread; here the next instruction from it is an undefined one", \
       "set a wait state for each 30 MHz begun, at 3.3 V, before the clock is switched")                               \
  RULE(voltage_scale, "PWR_CR", "RM0090, PWR power control register", "HCLK is above 144 MHz at voltage scale 2",      \
       "the core fails", "set VOS before the clock is switched")                                                       \
  RULE(hclk_too_fast, "RCC_CFGR", "RM0090, Clocks", "HCLK is above 168 MHz", "the core fails",                         \
       "divide by PLLP or HPRE")                                                                                       \
  RULE(pclk1_too_fast, "RCC_CFGR", "RM0090, Clocks", "PCLK1 is above 42 MHz", "peripherals of APB1 fail",              \
       "set PPRE1 before the clock is switched")                                                                       \
  RULE(pclk2_too_fast, "RCC_CFGR", "RM0090, Clocks", "PCLK2 is above 84 MHz", "peripherals of APB2 fail",              \
       "set PPRE2 before the clock is switched")                                                                       \
  RULE(pll_input, "RCC_PLLCFGR", "RM0090, RCC PLL configuration register", "The PLL's input is not 1 to 2 MHz",        \
       "it does not lock, or jitters", "set PLLM to the oscillator's MHz, or half of it")                              \
  RULE(pll_output, "RCC_PLLCFGR", "RM0090, RCC PLL configuration register", "The PLL's VCO is not at 100 to 432 MHz",  \
       "it does not lock", "correct PLLN")                                                                             \
  RULE(pll_written_while_on, "RCC_PLLCFGR", "RM0090, PLL configuration", "It was written while the PLL is on",         \
       "the write is ignored", "switch the PLL off first, and away from it before that")                               \
  RULE(clock_off, "RCC_xxxENR", "RM0090, Peripheral clock enable register",                                            \
       "A peripheral is used while its clock is off", "it reads 0 and ignores writes", "set its bit first")            \
  RULE(clock_fresh, "RCC_xxxENR", "ES0182, Delay after an RCC peripheral clock enabling",                              \
       "A peripheral is used before its clock has arrived", "the access is lost",                                      \
       "read the enable register back after writing it")                                                               \
  RULE(ccm_clock_off, "RCC_AHB1ENR", "RM0090, RCC AHB1 peripheral clock enable register",                              \
       "CCM is used while CCMDATARAMEN is 0", "the access is a BusFault",                                              \
       "set the bit before the first push; a boot loader may have cleared it")                                         \
  RULE(converter_too_fast, "ADC_CCR", "STM32F405 data sheet, ADC characteristics", "The ADC's clock is above 36 MHz",  \
       "conversions are wrong", "raise ADCPRE")                                                                        \
  RULE(converter_not_stable, "ADC_CR2", "STM32F405 data sheet, ADC characteristics",                                   \
       "A conversion starts less than 3 us after ADON", "its result is wrong", "wait 3 us")                            \
  RULE(reference_off, "ADC_CCR", "RM0090, Temperature sensor",                                                         \
       "The temperature sensor or the internal reference is converted while TSVREFE is 0", "its result means nothing", \
       "set TSVREFE first")                                                                                            \
  RULE(reference_hurried, "ADC_SMPR1", "STM32F405 data sheet, Embedded internal reference voltage",                    \
       "The temperature sensor or the internal reference is sampled in less than 10 us, or that soon after TSVREFE",   \
       "its result is wrong", "set SMP16 or SMP17 for the ADC's clock, and wait 10 us for it to start")                \
  RULE(analog_pin_mode, "GPIOx_MODER", "RM0090, Analog configuration",                                                 \
       "The ADC samples a pin that is not in analogue mode",                                                           \
       "the pull resistors and the input stage spoil the result", "set MODER to 0b11")                                 \
  RULE(timer_locked, "TIMx_BDTR", "RM0090, TIM1 and TIM8 break and dead-time register",                                \
       "A write would change bits that LOCK protects", "the bits stay", "configure first, lock last")                  \
  RULE(watchdog_busy, "IWDG_SR", "RM0090, IWDG status register",                                                       \
       "IWDG_PR or IWDG_RLR is written while PVU or RVU is set", "the value is lost", "wait until the flag is 0")      \
  RULE(copy_by_first_controller, "DMA_SxCR", "RM0090, DMA main features", "DMA1 is asked to move memory to memory",    \
       "nothing is moved", "take DMA2")                                                                                \
  RULE(usart_pin, "GPIOx_AFRx", "STM32F405 data sheet, Alternate function mapping",                                    \
       "A USART sends while none of its pins is in its alternate function", "nobody hears it", "connect its TX pin")   \
  RULE(usart_divider, "USART_BRR", "RM0090, Fractional baud rate generation",                                          \
       "A USART sends with a divider below 16, or 8 with OVER8", "it sends nothing that can be read", "set BRR first") \
  RULE(stream_flags_left, "DMA_SxCR", "RM0090, DMA stream configuration procedure",                                    \
       "A stream is enabled while flags of its last transfer are set", "its new transfer need not start",              \
       "clear all its flags by DMA_LIFCR or DMA_HIFCR first")                                                          \
  RULE(option_bytes_locked, "FLASH_OPTCR", "RM0090, Unlocking the option bytes",                                       \
       "It is written while OPTLOCK is set, or with a wrong key",                                                      \
       "the write is ignored; a wrong key locks until reset",                                                          \
       "write 0x08192A3B and 0x4C5D6E7F to FLASH_OPTKEYR first")                                                       \
  RULE(narrow_register_write, "", "RM0090, AHB/APB bridges; register map of the peripheral",                           \
       "A register is written by fewer bits than its peripheral takes",                                                \
       "the bridge repeats the bytes in the whole word", "write whole words, or half-words where the manual says so")  \
  RULE(usb_clock, "RCC_PLLCFGR", "RM0090, OTG_FS main features; USB 2.0, 7.1.11",                                      \
       "The USB core is attached with a clock that is not 48 MHz within 0.25 %", "the host hears nothing",             \
       "set PLLQ for 48 MHz, from the crystal")                                                                        \
  RULE(usb_pins, "GPIOA_AFRH", "RM0090, I/O pin alternate function multiplexer",                                       \
       "The USB core is attached while PA11 or PA12 is not in alternate function 10", "the host sees no device",       \
       "connect both pins")                                                                                            \
  RULE(usb_pull_up_unpowered, "OTG_FS_DCTL", "USB 2.0, 7.1.5", "D+ is pulled up while the cable brings no VBUS",       \
       "the device feeds current into a bus that is off", "sense VBUS, and set SDIS while it is not there")            \
  RULE(usb_transceiver, "OTG_FS_GUSBCFG", "RM0090, OTG_FS core initialization",                                        \
       "The USB core is attached without PHYSEL", "which transceiver it drives is left open", "set PHYSEL first")      \
  RULE(usb_core_reset, "OTG_FS_GRSTCTL", "RM0090, OTG_FS reset register",                                              \
       "The USB core is attached without CSRST since PHYSEL was set", "it keeps states of another transceiver",        \
       "reset the core after selecting the transceiver")                                                               \
  RULE(usb_mode, "OTG_FS_GUSBCFG", "RM0090, ID line detection",                                                        \
       "The USB core is attached as a device with neither FDMOD nor the ID pin PA10", "it may be a host",              \
       "set FDMOD, or PA10 to alternate function 10")                                                                  \
  RULE(usb_mode_wait, "OTG_FS_GUSBCFG", "RM0090, OTG_FS USB configuration register",                                   \
       "A register of device mode is written less than 25 ms after FDMOD", "the mode may not have changed yet",        \
       "wait 25 ms")                                                                                                   \
  RULE(usb_speed, "OTG_FS_DCFG", "RM0090, OTG_FS device configuration register",                                       \
       "The USB core is attached with DSPD other than 3", "the values are reserved: this core is full speed only",     \
       "set DSPD to 3")                                                                                                \
  RULE(usb_turnaround, "OTG_FS_GUSBCFG", "RM0090, TRDT values",                                                        \
       "The USB core is attached with TRDT too small for HCLK", "its answers are garbled",                             \
       "take it from the table: 6 from 32 MHz on, more below")                                                         \
  RULE(usb_narrow_access, "OTG_FS", "RM0090, OTG_FS control and status registers",                                     \
       "registers are read and written by whole words only", "other sizes do what nobody says", "use 32 bits")         \
  RULE(usb_endpoint_type, "OTG_FS_DIEPCTLx", "RM0090, OTG device endpoint x control register",                         \
       "A transfer begins on an endpoint other than 0 whose EPTYP says control",                                       \
       "the core takes only endpoint 0 for one", "write EPTYP with USBAEP")                                            \
  RULE(usb_no_such_fifo, "OTG_FS_GRSTCTL", "RM0090, OTG_FS reset register",                                            \
       "flush of a transmit FIFO that does not exist", "TXFFLSH may stay set", "use 0 to 3, or 16 for all")            \
  RULE(usb_size_while_enabled, "OTG_FS_DIEPTSIZx", "RM0090, OTG device IN endpoint x transfer size register",          \
       "the size of a transfer changes while its IN endpoint is enabled", "the transfer is garbled",                   \
       "wait for XFRC, or disable the endpoint first")                                                                 \
  RULE(usb_out_size_while_enabled, "OTG_FS_DOEPTSIZx", "RM0090, OTG device OUT endpoint x transfer size register",     \
       "the size of a transfer changes while its OUT endpoint is enabled", "the transfer is garbled",                  \
       "wait for XFRC, or disable the endpoint first")                                                                 \
  RULE(usb_flush_in_use, "OTG_FS_GRSTCTL", "RM0090, OTG_FS reset register",                                            \
       "a FIFO is flushed while the core may be using it", "packets of it are garbled",                                \
       "let NAK take effect first, of the endpoint or of all")                                                         \
  RULE(usb_disturbed, "OTG_FS_GRSTCTL", "RM0090, OTG_FS reset register; IN endpoint disable",                          \
       "the USB core gets a store that concerns what it is busy with", "neither has a defined end",                    \
       "wait until CSRST, RXFFLSH or TXFFLSH is 0 or EPDISD is 1, and 3 clocks of the PHY after CSRST")                \
  RULE(usb_disable_without_enable, "OTG_FS_DIEPCTLx", "RM0090, IN endpoint disable",                                   \
       "EPDIS has no effect on an endpoint that is not enabled", "EPDISD does not come", "look at EPENA first")        \
  RULE(usb_no_packets, "OTG_FS_DxEPTSIZx", "RM0090, OTG_FS device programming model",                                  \
       "endpoint enabled with a packet count of 0", "the transfer never ends", "write PKTCNT first")                   \
  RULE(usb_bytes_beyond_packets, "OTG_FS_DIEPTSIZx", "RM0090, OTG device IN endpoint x transfer size register",        \
       "IN transfer has more bytes than its packets hold", "it ends early", "write PKTCNT by XFRSIZ and MPSIZ")        \
  RULE(usb_inactive_endpoint, "OTG_FS_DxEPCTLx", "RM0090, USB endpoint activation",                                    \
       "endpoint enabled that is not active in this configuration", "the host gets no answer", "set USBAEP")           \
  RULE(usb_stale_words, "OTG_FS_GRSTCTL", "RM0090, Operations of IN data transfers",                                   \
       "IN endpoint enabled while its FIFO holds words of an earlier transfer", "the host gets the old words",         \
       "flush the FIFO")                                                                                               \
  RULE(usb_fifo_too_small, "OTG_FS_DIEPTXFx", "RM0090, Peripheral FIFO architecture",                                  \
       "a packet of this transfer does not fit the transmit FIFO", "it never goes out", "make the FIFO larger")        \
  RULE(usb_interleaved, "OTG_FS", "ES0182, Transmit data FIFO is corrupted when the write sequence is interrupted",    \
       "a packet's FIFO writes are interleaved with other accesses; the packet is damaged",                            \
       "it goes out with a bad CRC until the FIFO is flushed", "write a packet in one go, interrupts off")             \
  RULE(usb_fifo_packets, "OTG_FS_DIEPTXFx", "RM0090, IN endpoint data transfer",                                       \
       "More than eight packets stand in a transmit FIFO", "the endpoint hangs: their count has three bits",           \
       "make the FIFO eight packets long at most")                                                                     \
  RULE(usb_fifo_full, "OTG_FS_DTXFSTSx", "RM0090, OTG device IN endpoint transmit FIFO status register",               \
       "a word was written to a full transmit FIFO and is lost", "the packet is short of it", "look at DTXFSTS first") \
  RULE(usb_fifo_before_enable, "OTG_FS_DIEPCTLx", "RM0090, Operations of IN data transfers",                           \
       "the FIFO of an IN endpoint was written before the endpoint was enabled", "words and transfer do not match",    \
       "set EPENA and CNAK first")                                                                                     \
  RULE(usb_words_beyond_transfer, "OTG_FS_DIEPTSIZx", "RM0090, Operations of IN data transfers",                       \
       "more words were written to a transmit FIFO than the transfer has", "they go out with the next one",            \
       "write as many as XFRSIZ says")                                                                                 \
  RULE(usb_memory_exceeded, "OTG_FS_DIEPTXFx", "RM0090, FIFO RAM allocation",                                          \
       "a FIFO reaches beyond the 320 words of packet memory", "it overwrites another", "make it smaller")             \
  RULE(usb_memory_overlap, "OTG_FS_DIEPTXFx", "RM0090, FIFO RAM allocation", "two FIFOs overlap in packet memory",     \
       "they overwrite each other", "let each begin where the last one ends")                                          \
  RULE(usb_out_disable, "OTG_FS_DOEPCTLx", "RM0090, Disabling an OUT endpoint",                                        \
       "EPDIS has no effect on OUT endpoint 0 or an endpoint that is not enabled", "EPDISD does not come",             \
       "look at EPENA first")                                                                                          \
  RULE(usb_out_disable_early, "OTG_FS_DOEPCTLx", "RM0090, Disabling an OUT endpoint",                                  \
       "an OUT endpoint is disabled before the global OUT NAK is effective; it waits", "packets may be lost",          \
       "wait for GONAKEFF")                                                                                            \
  RULE(usb_out_size, "OTG_FS_DOEPTSIZx", "RM0090, OTG device OUT endpoint x transfer size register",                   \
       "the size of an OUT transfer is not a multiple of the packet size", "a full packet overruns it",                \
       "round XFRSIZ up to MPSIZ")                                                                                     \
  RULE(usb_out_overrun, "OTG_FS_DOEPTSIZx", "RM0090, Operations of OUT data transfers",                                \
       "an OUT packet is larger than the rest of its transfer", "the rest of it has no place",                         \
       "round XFRSIZ up to MPSIZ")                                                                                     \
  RULE(usb_nak_cleared_early, "OTG_FS_DOEPCTL0", "RM0090, SETUP and OUT data transfers",                               \
       "CNAK on OUT endpoint 0 before the setup-done word was popped; the word is lost", "STUP never comes",           \
       "pop it first")                                                                                                 \
  RULE(usb_pop_empty, "OTG_FS_GRXSTSP", "RM0090, Packet read", "GRXSTSP was read while the receive FIFO was empty",    \
       "what it gives means nothing", "look at RXFLVL first")                                                          \
  RULE(usb_pop_before_data, "OTG_FS_GRXSTSP", "RM0090, Packet read",                                                   \
       "GRXSTSP was read before the data of the packet before; a data word is taken for a status",                     \
       "all that follows is misread", "read BCNT bytes of data first")                                                 \
  RULE(usb_read_beyond_packet, "OTG_FS", "RM0090, Packet read", "the receive FIFO was read beyond the packet",         \
       "words of the next packet are lost", "read BCNT bytes")                                                         \
  RULE(usb_no_room_for_setup, "OTG_FS_GRXFSIZ", "RM0090, Peripheral FIFO architecture",                                \
       "a SETUP packet found no room in the receive FIFO", "it is lost", "keep ten words for them")

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

/// Chip interfaces for peripherals that are defined outside of this library.
struct ChipConnections {
  Scheduler& scheduler;
  InterruptController& interrupts;
  UnmodelledLog& log;
  RuleKeeper& rules;
  const ChipState& state;
  TriggerLines& triggers;
};

}  // namespace inkwell::virtual_board
