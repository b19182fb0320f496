// Creates firmware images with content from the test.
#pragma once

#include <elf.h>

#include <cstring>
#include <vector>

#include "host/client/firmware_update/image.hpp"

namespace inkwell::tests {

inline std::vector<std::byte> made_elf(const std::vector<firmware_update::Segment>& segments) {
  Elf32_Ehdr header{};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_ident[EI_CLASS] = ELFCLASS32;
  header.e_ident[EI_DATA] = ELFDATA2LSB;
  header.e_type = ET_EXEC;
  header.e_machine = EM_ARM;
  header.e_phoff = sizeof header;
  header.e_phentsize = sizeof(Elf32_Phdr);
  header.e_phnum = static_cast<Elf32_Half>(segments.size());
  std::vector<std::byte> file(sizeof header + segments.size() * sizeof(Elf32_Phdr));
  std::memcpy(file.data(), &header, sizeof header);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    Elf32_Phdr segment{};
    segment.p_type = PT_LOAD;
    segment.p_offset = static_cast<Elf32_Off>(file.size());
    segment.p_paddr = segments[i].address;
    segment.p_filesz = segment.p_memsz = static_cast<Elf32_Word>(segments[i].bytes.size());
    std::memcpy(file.data() + sizeof header + i * sizeof segment, &segment, sizeof segment);
    file.insert(file.end(), segments[i].bytes.begin(), segments[i].bytes.end());
  }
  return file;
}

/// Returns an image with this identity and a valid checksum. The code is not in the sector of the vectors.
inline std::vector<firmware_update::Segment> made_segments(const protocol::ImageIdentity& identity) {
  std::vector<firmware_update::Segment> segments{
      {protocol::image_begin, std::vector<std::byte>(firmware_update::identity_end + 2)},  // multiple of the word size
      {protocol::image_begin + 0x1'0000, std::vector<std::byte>(4000)}};
  constexpr std::uint32_t vectors[] = {0x2001'0000, protocol::image_begin + 0x1'0001};
  std::memcpy(segments[0].bytes.data(), vectors, sizeof vectors);
  std::memcpy(segments[0].bytes.data() + protocol::image_identity_offset, &identity, sizeof identity);
  for (std::size_t i = 0; i < segments[1].bytes.size(); ++i) segments[1].bytes[i] = std::byte(i * 11);
  firmware_update::WordChecksum checksum;
  for (const auto& segment : segments)
    for (std::size_t i = 0; i < segment.bytes.size(); i += 4) {
      std::uint32_t word = 0;
      std::memcpy(&word, segment.bytes.data() + i, 4);
      checksum.add(word);
    }
  const std::uint32_t sum = checksum.value();
  const auto* bytes = reinterpret_cast<const std::byte*>(&sum);
  segments[1].bytes.insert(segments[1].bytes.end(), bytes, bytes + 4);
  return segments;
}

}  // namespace inkwell::tests
