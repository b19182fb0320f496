// Flash, SRAM, CCM and system memory (RM0090, memory map).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "boards/stm32f405/core/address_space.hpp"
#include "boards/stm32f405/core/memory_map.hpp"

namespace inkwell::virtual_board {

/// Bytes of the memories after power-on: the flash is erased.
struct MemoryBytes {
  MemoryBytes();
  // Unicorn requires page-aligned sizes with pages of 4 KB. The host memory needs no alignment.
  std::vector<std::uint8_t> flash, sram, ccm, system;
};

class Memory final : private MemoryBytes, public AddressSpace {
 public:
  Memory() : AddressSpace(MemoryBytes::flash, MemoryBytes::sram, MemoryBytes::ccm, MemoryBytes::system) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
};

/// Erases the flash sectors that the load segments of an ELF file overlap, and writes the segments at their physical
/// addresses. Throws ChipError with the name of the file. Returns a warning about a questionable stack pointer, or an
/// empty string.
std::string program_elf(std::span<const char> file, const std::string& name, AddressSpace& memory);

}  // namespace inkwell::virtual_board
