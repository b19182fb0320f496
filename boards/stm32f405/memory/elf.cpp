// Reads the load segments of an ELF file (ELF for the ARM architecture, AAELF32).
#include <elf.h>

#include <algorithm>
#include "boards/stm32f405/core/chip_error.hpp"
#include "boards/stm32f405/memory/memory.hpp"

namespace inkwell::virtual_board {
namespace {

template <class T>
T record_at(std::span<const char> file, std::size_t offset, const std::string& name) {
  if (offset > file.size() || sizeof(T) > file.size() - offset)
    throw ChipError(name + " is truncated: the headers are incomplete. Build or copy the file again.");
  T record;
  std::memcpy(&record, file.data() + offset, sizeof record);
  return record;
}

std::string machine_name(unsigned machine) {
  switch (machine) {
    case EM_386: return "x86";
    case EM_X86_64: return "x86-64 (a PC program)";
    case EM_AARCH64: return "64-bit ARM";
    case EM_ARM: return "ARM with another word size or byte order";
    case EM_RISCV: return "RISC-V";
    case EM_XTENSA: return "Xtensa";
    case EM_AVR: return "AVR";
    default: return "machine number " + std::to_string(machine);
  }
}

void check_header(const Elf32_Ehdr& header, const std::string& name) {
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
    throw ChipError(name + " is not an ELF file. Give the .elf that the linker writes, not a .bin or .hex.");
  if (header.e_ident[EI_CLASS] != ELFCLASS32 || header.e_ident[EI_DATA] != ELFDATA2LSB || header.e_machine != EM_ARM)
    throw ChipError(name + " is not for a 32-bit ARM processor, but for " + machine_name(header.e_machine) +
                    ". Build it with a cross compiler: arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb.");
  if (header.e_type != ET_EXEC)
    throw ChipError(name + " is not a linked executable. Link it with a linker script for the STM32F405.");
  if (header.e_phnum == 0 || header.e_phentsize != sizeof(Elf32_Phdr))
    throw ChipError(name + " has no load segments. Link it with a linker script for the STM32F405.");
}

/// Load segments of an ELF file.
struct Image {
  std::span<const char> file;
  std::vector<Elf32_Phdr> segments;
  /// Returns the byte at `address`, or 0xFF (erased flash) outside of all segments.
  std::uint8_t byte(std::uint32_t address) const {
    std::uint8_t value = 0xFF;
    for (const auto& segment : segments)
      if (address >= segment.p_paddr && address - segment.p_paddr < segment.p_filesz)
        value = static_cast<std::uint8_t>(file[segment.p_offset + (address - segment.p_paddr)]);
    return value;
  }
  std::uint32_t word(std::uint32_t address) const {
    std::uint32_t value = 0;
    for (std::uint32_t i = 4; i-- > 0;) value = value << 8 | byte(address + i);
    return value;
  }
};

std::string range_of(std::uint32_t base, std::uint32_t bytes) {
  return hexadecimal(base) + " to " + hexadecimal(base + bytes - 1);
}

/// Checks the initial stack pointer and the reset vector at the start of the flash (ARMv7-M, B1.5.5). Returns a
/// warning about the stack pointer, or an empty string.
std::string check_vectors(const Image& image, const std::string& name, AddressSpace& memory) {
  const std::uint32_t stack = image.word(flash_base), reset = image.word(flash_base + 4);
  const std::string table = "at " + hexadecimal(flash_base) +
                            ", from which the processor loads the initial stack pointer and " +
                            "the address of the first instruction";
  if (stack == 0xFFFF'FFFF && reset == 0xFFFF'FFFF) {
    std::uint32_t lowest = 0xFFFF'FFFF;
    for (const auto& segment : image.segments) lowest = std::min<std::uint32_t>(lowest, segment.p_paddr);
    throw ChipError(name + " has no data " + table + "; the lowest address is " + hexadecimal(lowest) +
                    ". The file may be an application that a boot loader starts. Link the application to " +
                    hexadecimal(flash_base) + ", or combine both in one ELF file.");
  }
  if ((reset & 1) == 0 || memory.at(reset & ~1u, 2) == nullptr)
    throw ChipError(name + " has no vector table " + table + ": the values are " + hexadecimal(stack) + " and " +
                    hexadecimal(reset) +
                    ". Correct the linker script: the vector section must be first and needs KEEP.");
  if (memory.ram_at(stack - 4, 4) != nullptr) return {};
  return name + " has the initial stack pointer " + hexadecimal(stack) +
         ", which is outside of the RAM of the STM32F405 (" + range_of(sram_base, sram_bytes) + " and " +
         range_of(ccm_base, ccm_bytes) +
         "). The firmware is for another chip, unless it sets the stack pointer itself.";
}

/// Erases the sectors of the segment. Other sectors remain unchanged.
void erase_sectors_of(const Elf32_Phdr& segment, AddressSpace& memory) {
  const std::uint32_t first = segment.p_paddr - flash_base;
  for (unsigned i = 0; i < flash_sectors; ++i) {
    const auto [offset, bytes] = flash_sector(i);
    if (first < offset + bytes && offset < first + segment.p_filesz) std::memset(memory.flash() + offset, 0xFF, bytes);
  }
}

}  // namespace

std::string program_elf(std::span<const char> file, const std::string& name, AddressSpace& memory) {
  if (file.size() < SELFMAG || std::memcmp(file.data(), ELFMAG, SELFMAG) != 0)
    throw ChipError(name + " is not an ELF file. Give the .elf that the linker writes, not a .bin or .hex.");

  const auto header = record_at<Elf32_Ehdr>(file, 0, name);
  check_header(header, name);

  std::vector<Elf32_Phdr> segments;
  for (unsigned i = 0; i < header.e_phnum; ++i) {
    auto segment = record_at<Elf32_Phdr>(file, std::size_t{header.e_phoff} + i * sizeof(Elf32_Phdr), name);
    if (segment.p_type != PT_LOAD || segment.p_filesz == 0) continue;
    if (segment.p_offset > file.size() || segment.p_filesz > file.size() - segment.p_offset)
      throw ChipError(name + " is truncated: its segment at " + hexadecimal(segment.p_paddr) +
                      " is incomplete. Build or copy the file again.");
    if (segment.p_paddr < flash_bytes) segment.p_paddr += flash_base;  // at a reset the flash is also mapped at 0
    if (memory.at(segment.p_paddr, segment.p_filesz) == nullptr)
      throw ChipError(name + " does not fit the STM32F405: " + std::to_string(segment.p_filesz) + " bytes at " +
                      hexadecimal(segment.p_paddr) + " are outside of its memories. Correct the linker script.");
    segments.push_back(segment);
  }
  if (segments.empty()) throw ChipError(name + " has no data to load. Link it with a linker script for the STM32F405.");
  const std::string oddity = check_vectors({file, segments}, name, memory);

  // The flash contents are replaced only after all checks of the file have passed.
  for (const auto& segment : segments) erase_sectors_of(segment, memory);
  for (const auto& segment : segments)
    std::memcpy(memory.at(segment.p_paddr, segment.p_filesz), file.data() + segment.p_offset, segment.p_filesz);
  return oddity;
}

}  // namespace inkwell::virtual_board
