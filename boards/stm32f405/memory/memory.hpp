// Flash, SRAM, CCM and system memory (RM0090, memory map).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "boards/stm32f405/core/address_space.hpp"
#include "boards/stm32f405/core/memory_map.hpp"

namespace inkwell::virtual_board {

/// Contents of the memories.
struct MemoryBytes {
  MemoryBytes();
  // Unicorn requires sizes that are multiples of 4 KB.
  std::vector<std::uint8_t> flash, sram, ccm, system;
};

class Memory final : private MemoryBytes, public AddressSpace {
 public:
  Memory() : AddressSpace(MemoryBytes::flash, MemoryBytes::sram, MemoryBytes::ccm, MemoryBytes::system) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
};

/// Writes the load segments of an ELF file to their physical addresses. The sectors of the segments are erased first.
/// Throws ChipError if the file is invalid. Returns a warning about a questionable stack pointer, or an empty string.
std::string program_elf(std::span<const char> file, const std::string& name, AddressSpace& memory);

}  // namespace inkwell::virtual_board
