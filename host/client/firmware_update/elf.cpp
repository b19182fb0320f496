#include "host/client/firmware_update/elf.hpp"

#include <elf.h>

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace inkwell::firmware_update {
namespace {

template <class Record>
Record record_at(std::span<const std::byte> file, std::size_t offset, const std::string& name) {
  if (offset > file.size() || sizeof(Record) > file.size() - offset)
    throw NoImage(fmt::format("{} is incomplete. Build or copy it again.", name));
  Record record;
  std::memcpy(&record, file.data() + offset, sizeof record);
  return record;
}

}  // namespace

std::vector<Segment> load_segments(std::span<const std::byte> file, const std::string& name) {
  if (file.size() < SELFMAG || std::memcmp(file.data(), ELFMAG, SELFMAG) != 0)
    throw NoImage(
        fmt::format("{} is not an ELF file. Give the .elf file of a firmware, not a .bin or .hex file.", name));
  const auto header = record_at<Elf32_Ehdr>(file, 0, name);
  if (header.e_ident[EI_CLASS] != ELFCLASS32 || header.e_ident[EI_DATA] != ELFDATA2LSB || header.e_machine != EM_ARM ||
      header.e_type != ET_EXEC || header.e_phentsize != sizeof(Elf32_Phdr))
    throw NoImage(
        fmt::format("{} is not a program for a 32-bit ARM processor. Give the .elf file of a firmware.", name));
  std::vector<Segment> segments;
  for (unsigned i = 0; i < header.e_phnum; ++i) {
    const auto segment = record_at<Elf32_Phdr>(file, std::size_t{header.e_phoff} + i * sizeof(Elf32_Phdr), name);
    if (segment.p_type != PT_LOAD || segment.p_filesz == 0) continue;
    if (segment.p_offset > file.size() || segment.p_filesz > file.size() - segment.p_offset)
      throw NoImage(fmt::format("{} is incomplete. Build or copy it again.", name));
    const auto bytes = file.subspan(segment.p_offset, segment.p_filesz);
    segments.push_back({segment.p_paddr, {bytes.begin(), bytes.end()}});
  }
  return segments;
}

}  // namespace inkwell::firmware_update
