// Memory addresses of an STM32F405 with 1 MB of flash (RM0090 2.3).
#pragma once

#include <cstdint>

namespace inkwell::virtual_board {

inline constexpr std::uint32_t flash_base = 0x0800'0000, flash_bytes = 1024 * 1024;
inline constexpr std::uint32_t sram_base = 0x2000'0000, sram_bytes = 128 * 1024;  ///< SRAM1 and SRAM2 are adjacent
inline constexpr std::uint32_t sram1_bytes = 112 * 1024;
inline constexpr std::uint32_t ccm_base = 0x1000'0000, ccm_bytes = 64 * 1024;
inline constexpr std::uint32_t private_bus_base = 0xE000'0000, private_bus_bytes = 0x10'0000;  ///< of the core
inline constexpr std::uint32_t system_base = 0x1FFF'0000, system_bytes = 64 * 1024;            ///< with option bytes

/// Memory that is also mapped at address 0. The values match SYSCFG_MEMRMP.MEM_MODE. The model has no FSMC (value 2).
enum class MemoryAtZero : std::uint8_t { flash = 0, system = 1, sram1 = 3 };

struct FlashSector {
  std::uint32_t offset, bytes;  ///< offset within the flash
};
inline constexpr unsigned flash_sectors = 12;
constexpr FlashSector flash_sector(unsigned number) {
  if (number < 4) return {number * 0x4000, 0x4000};
  if (number == 4) return {0x1'0000, 0x1'0000};
  return {(number - 4) * 0x2'0000, 0x2'0000};
}

}  // namespace inkwell::virtual_board
