// Register maps and base addresses of the peripherals (RM0090, "Memory map"; ARMv7-M Architecture Reference Manual).
#pragma once

// To add a peripheral, write its register map in a header in this folder and add a row to one of the tables below.

#include "firmware/registers/analog_converter.hpp"
#include "firmware/registers/checksum.hpp"
#include "firmware/registers/clock.hpp"
#include "firmware/registers/direct_memory_access.hpp"
#include "firmware/registers/flash_programming.hpp"
#include "firmware/registers/general_purpose_io.hpp"
#include "firmware/registers/otg_fs.hpp"
#include "firmware/registers/processor.hpp"
#include "firmware/registers/serial_port.hpp"
#include "firmware/registers/timer.hpp"
#include "firmware/registers/watchdog.hpp"

/// X(name, map, base). Only the claiming driver may use these peripherals (drivers::RegistersOf).
#define INKWELL_CLAIMABLE_PERIPHERALS(X)             \
  X(TIM2, CaptureTimer, 0x40000000)                  \
  X(TIM3, EncoderTimer, 0x40000400)                  \
  X(TIM4, EncoderTimer, 0x40000800)                  \
  X(TIM5, EncoderTimer, 0x40000C00)                  \
  X(IWDG, IndependentWatchdog, 0x40003000)           \
  X(USART2, SerialPort, 0x40004400)                  \
  X(TIM1, AdvancedTimer, 0x40010000)                 \
  X(TIM8, AdvancedTimer, 0x40010400)                 \
  X(ADC1, AnalogConverter, 0x40012000)               \
  X(ADC2, AnalogConverter, 0x40012100)               \
  X(ADC3, AnalogConverter, 0x40012200)               \
  X(ADC_COMMON, AnalogConverterCommon, 0x40012300)   \
  X(EXTI, InterruptLines, 0x40013C00)                \
  X(CRC, ChecksumUnit, 0x40023000)                   \
  X(FLASH_PROGRAMMING, FlashProgramming, 0x40023C00) \
  X(DMA2, DirectMemoryAccess, 0x40026400)            \
  X(OTG_FS_GLOBAL, UsbGlobal, 0x50000000)            \
  X(OTG_FS_DEVICE, UsbDevice, 0x50000800)            \
  X(OTG_FS_PWRCLK, UsbPower, 0x50000E00)             \
  X(OTG_FS_FIFO, UsbFifo, 0x50001000)

/// X(name, map, base). All code may use these peripherals, for example `registers::RCC::CR::read()`. Pins of a port are
/// claimed separately.
#define INKWELL_SHARED_PERIPHERALS(X)                    \
  X(SIGNATURE, DeviceSignature, 0x1FFF7A10)              \
  X(PWR, PowerControl, 0x40007000)                       \
  X(SYSCFG, SystemConfiguration, 0x40013800)             \
  X(GPIOA, GeneralPurposeIo, 0x40020000)                 \
  X(GPIOB, GeneralPurposeIo, 0x40020400)                 \
  X(GPIOC, GeneralPurposeIo, 0x40020800)                 \
  X(RCC, ResetAndClockControl, 0x40023800)               \
  X(FLASH, FlashInterface, 0x40023C00)                   \
  X(DWT, DataWatchpointAndTrace, 0xE0001000)             \
  X(NVIC, NestedVectoredInterruptController, 0xE000E100) \
  X(SCB, SystemControlBlock, 0xE000ED00)                 \
  X(FPU_CPACR, CoprocessorAccess, 0xE000ED88)            \
  X(MPU, MemoryProtectionUnit, 0xE000ED90)               \
  X(CORE_DEBUG, CoreDebug, 0xE000EDF0)                   \
  X(DBG, DebugSupport, 0xE0042000)

namespace inkwell::registers {

/// Identifies a peripheral without access to its registers.
template <template <std::uint32_t> class Map, std::uint32_t base>
struct Claimable {};

#define X(name, Map, base) using name = Claimable<Map, base>;
INKWELL_CLAIMABLE_PERIPHERALS(X)
#undef X
#define X(name, Map, base) using name = Map<base>;
INKWELL_SHARED_PERIPHERALS(X)
#undef X

}  // namespace inkwell::registers
