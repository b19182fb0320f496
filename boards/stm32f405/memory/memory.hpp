// Flash, SRAM, CCM and system memory (RM0090, memory map).
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "boards/stm32f405/memory/memory_map.hpp"

namespace inkwell::virtual_board {

/// Formats a number in hexadecimal, for example 0x08000000.
std::string hexadecimal(std::uint32_t value);

class Memory {
 public:
  Memory();
  std::uint8_t* flash() { return flash_.data(); }
  std::uint8_t* sram() { return sram_.data(); }
  std::uint8_t* ccm() { return ccm_.data(); }
  std::uint8_t* system() { return system_.data(); }

  /// Host pointer to the `bytes` bytes at `address`, or nullptr if no single memory contains all bytes.
  std::uint8_t* at(std::uint32_t address, std::uint32_t bytes);
  const std::uint8_t* at(std::uint32_t address, std::uint32_t bytes) const {
    return const_cast<Memory*>(this)->at(address, bytes);
  }
  /// Like at(), but only for RAM (SRAM and CCM).
  std::uint8_t* ram_at(std::uint32_t address, std::uint32_t bytes);
  std::uint32_t word(std::uint32_t address) const {
    std::uint32_t value = 0;
    if (const auto* place = at(address, 4)) std::memcpy(&value, place, 4);
    return value;
  }
  std::uint16_t half_word(std::uint32_t address) const {
    std::uint16_t value = 0;
    if (const auto* place = at(address, 2)) std::memcpy(&value, place, 2);
    return value;
  }

 private:
  // Unicorn requires page-aligned sizes with pages of 4 KB. The host memory needs no alignment.
  std::vector<std::uint8_t> flash_, sram_, ccm_, system_;
};

/// Erases the flash sectors that the load segments of an ELF file overlap, and writes the segments at their physical
/// addresses. Throws ChipError with the name of the file. Returns a warning about a questionable stack pointer, or an
/// empty string.
std::string program_elf(std::span<const char> file, const std::string& name, Memory& memory);

}  // namespace inkwell::virtual_board
