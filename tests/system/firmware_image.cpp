#include "tests/system/firmware_image.hpp"

#include <elf.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

std::string read_firmware() {
  std::ifstream file(build_directory() + "/../board/inkwell.elf", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <class Header>
Header read_header(const std::string& elf, std::size_t offset) {
  Header header;
  REQUIRE(elf.size() >= offset + sizeof header);
  std::memcpy(&header, elf.data() + offset, sizeof header);
  return header;
}

std::vector<Elf32_Shdr> read_sections(const std::string& elf) {
  const auto header = read_header<Elf32_Ehdr>(elf, 0);
  std::vector<Elf32_Shdr> sections;
  for (std::size_t i = 0; i < header.e_shnum; ++i)
    sections.push_back(read_header<Elf32_Shdr>(elf, header.e_shoff + i * sizeof(Elf32_Shdr)));
  return sections;
}

}  // namespace

FirmwareSymbol find_symbol(std::string_view name) {
  const std::string elf = read_firmware();
  const auto sections = read_sections(elf);
  const auto symbols = std::ranges::find(sections, Elf32_Word{SHT_SYMTAB}, &Elf32_Shdr::sh_type);
  REQUIRE(symbols != sections.end());
  const std::size_t names = sections.at(symbols->sh_link).sh_offset;
  std::vector<FirmwareSymbol> found;
  for (std::size_t offset = 0; offset < symbols->sh_size; offset += sizeof(Elf32_Sym)) {
    const auto symbol = read_header<Elf32_Sym>(elf, symbols->sh_offset + offset);
    if (std::string_view(elf.c_str() + names + symbol.st_name).find(name) != std::string_view::npos)
      found.push_back({symbol.st_value & ~1u, symbol.st_size});
  }
  INFO("the firmware's symbol ", name);
  REQUIRE(found.size() == 1);
  return found[0];
}

std::uint32_t endless_loop_address() {
  constexpr std::string_view loop = "\xBF\xF3\x4F\x8F\xFC\xE7";
  const FirmwareSymbol waits_for_reset = find_symbol("17start_boot_loader");
  const std::string elf = read_firmware();
  const auto header = read_header<Elf32_Ehdr>(elf, 0);
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    const auto segment = read_header<Elf32_Phdr>(elf, header.e_phoff + i * sizeof(Elf32_Phdr));
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_X) == 0) continue;
    for (std::uint32_t offset = 0; offset + loop.size() <= segment.p_filesz; offset += 2)
      if (waits_for_reset.contains(segment.p_paddr + offset) &&
          elf.compare(segment.p_offset + offset, loop.size(), loop) == 0)
        return segment.p_paddr + offset;
  }
  FAIL("the firmware holds no endless loop to jump to");
  return 0;
}

std::string firmware_compiler_version() {
  // "GCC: (vendor's version) 12.2.1 20221205"
  const std::string elf = read_firmware();
  const auto start = elf.find("GCC: (");
  REQUIRE(start != std::string::npos);
  const std::string text(elf.c_str() + start);
  const auto version = text.find(") ") + 2;
  return text.substr(version, text.rfind('.') - version);
}

}  // namespace inkwell::tests
