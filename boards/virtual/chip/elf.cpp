// Reader for the few parts of an ELF file that a programmer needs (ELF for the ARM architecture, AAELF32).
#include <elf.h>

#include <chip/chip.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "memory.hpp"

namespace inkwell::virtual_board {
namespace {

std::string hexadecimal(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08X", static_cast<unsigned>(value));
  return text;
}

template <class T>
T record_at(const std::vector<char>& file, std::size_t offset, const std::string& name) {
  if (offset > file.size() || sizeof(T) > file.size() - offset)
    throw ChipError(name + " is truncated: it ends before its own headers do. Build or copy it again.");
  T record;
  std::memcpy(&record, file.data() + offset, sizeof record);
  return record;
}

void check_header(const Elf32_Ehdr& header, const std::string& name) {
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
    throw ChipError(name + " is not an ELF file. Give the .elf that the linker writes, not a .bin or .hex.");
  if (header.e_ident[EI_CLASS] != ELFCLASS32 || header.e_ident[EI_DATA] != ELFDATA2LSB || header.e_machine != EM_ARM)
    throw ChipError(name + " is not for a 32-bit ARM processor. Build it with tools/cmake/arm-none-eabi.cmake.");
  if (header.e_type != ET_EXEC)
    throw ChipError(name + " is not a linked executable. Link it with a linker script for the STM32F405.");
  if (header.e_phnum == 0 || header.e_phentsize != sizeof(Elf32_Phdr))
    throw ChipError(name + " has no load segments. Link it with a linker script for the STM32F405.");
}

}  // namespace

void program_elf(const std::filesystem::path& path, Memory& memory) {
  const std::string name = path.string();
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw ChipError(name + " is a folder. Give the ELF file of the firmware.");
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    throw ChipError("There is no readable file " + name + ". Build the firmware first, or correct the path.");
  const std::vector<char> file{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (file.size() < SELFMAG || std::memcmp(file.data(), ELFMAG, SELFMAG) != 0)
    throw ChipError(name + " is not an ELF file. Give the .elf that the linker writes, not a .bin or .hex.");

  const auto header = record_at<Elf32_Ehdr>(file, 0, name);
  check_header(header, name);

  std::vector<Elf32_Phdr> segments;
  for (unsigned i = 0; i < header.e_phnum; ++i) {
    const auto segment = record_at<Elf32_Phdr>(file, std::size_t{header.e_phoff} + i * sizeof(Elf32_Phdr), name);
    if (segment.p_type != PT_LOAD || segment.p_filesz == 0) continue;
    if (segment.p_offset > file.size() || segment.p_filesz > file.size() - segment.p_offset)
      throw ChipError(name + " is truncated: its segment at " + hexadecimal(segment.p_paddr) +
                      " is not all in the file. Build or copy it again.");
    if (memory.at(segment.p_paddr, segment.p_filesz) == nullptr)
      throw ChipError(name + " does not fit the STM32F405: " + std::to_string(segment.p_filesz) + " bytes at " +
                      hexadecimal(segment.p_paddr) + " lie outside of its memories. Correct the linker script.");
    segments.push_back(segment);
  }
  if (segments.empty()) throw ChipError(name + " has nothing to load. Link it with a linker script for the STM32F405.");

  // Only a file that is whole may replace what is in the flash.
  std::memset(memory.flash(), 0xFF, flash_bytes);
  for (const auto& segment : segments)
    std::memcpy(memory.at(segment.p_paddr, segment.p_filesz), file.data() + segment.p_offset, segment.p_filesz);
}

}  // namespace inkwell::virtual_board
