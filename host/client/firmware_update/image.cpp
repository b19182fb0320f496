#include "host/client/firmware_update/image.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "boards/known/boards.hpp"
#include "host/client/installation/installed_paths.hpp"

#include "host/client/firmware_update/elf.hpp"

namespace inkwell::firmware_update {
namespace {

constexpr std::uint32_t flash_begin = protocol::image_begin, flash_bytes = protocol::flash_bytes;
constexpr std::uint32_t polynomial = 0x04C1'1DB7;
constexpr std::size_t file_maximum = 64u << 20;  // the real image, including debug information, has one fiftieth of
                                                 // this size

std::string version_of(const protocol::ImageIdentity& identity) {
  return fmt::format("{}", fmt::join(identity.version(), "."));
}

/// The build appends a checksum to the image (tools/generate/seal_image.py).
bool is_sealed(const std::vector<Segment>& segments) {
  WordChecksum checksum;
  std::uint32_t word = 0;
  std::uint64_t bytes = 0;
  for (const Segment& segment : segments)
    for (const std::byte byte : segment.bytes) {
      if (bytes % 4 == 0 && bytes != 0) checksum.add(word);
      word = word >> 8 | std::to_integer<std::uint32_t>(byte) << 24;
      ++bytes;
    }
  return bytes % 4 == 0 && bytes > 4 && checksum.value() == word;
}

}  // namespace

void WordChecksum::add(std::uint32_t word) {
  rest_ ^= word;
  for (int i = 0; i < 32; ++i) rest_ = (rest_ & 0x8000'0000) != 0 ? rest_ << 1 ^ polynomial : rest_ << 1;
}

std::optional<std::byte> Image::at(std::uint32_t address) const {
  for (const Segment& segment : segments)
    if (address >= segment.address && address < segment.end()) return segment.bytes[address - segment.address];
  return {};
}

std::optional<protocol::ImageIdentity> identity_in(std::span<const std::byte> begin_of_flash) {
  protocol::ImageIdentity identity{};
  if (begin_of_flash.size() < identity_end) return {};
  std::memcpy(&identity, begin_of_flash.data() + protocol::image_identity_offset, sizeof identity);
  return identity.is_there() ? std::optional(identity) : std::nullopt;
}

Image read_image(std::span<const std::byte> elf, const std::filesystem::path& file) {
  const std::string name = file.string();
  Image image{.file = file, .segments = load_segments(elf, name)};
  std::ranges::sort(image.segments, {}, &Segment::address);
  std::uint64_t end = flash_begin;
  for (const Segment& segment : image.segments) {
    const std::uint64_t segment_end = std::uint64_t{segment.address} + segment.bytes.size();
    if (segment.address < end || segment_end > flash_begin + flash_bytes)
      throw NoImage(
          fmt::format("{} is not a program for the flash of an STM32F405: it has {} bytes at 0x{:08x}. Give the .elf "
                      "file of a firmware.",
                      name, segment.bytes.size(), segment.address));
    end = segment_end;
  }
  if (image.segments.empty() || image.segments.front().address != flash_begin)
    throw NoImage(
        fmt::format("{} has no vector table at the beginning of the flash. Give the .elf file of a firmware.", name));
  std::vector<std::byte> begin;
  for (std::uint32_t i = 0; i < identity_end; ++i) begin.push_back(image.at(flash_begin + i).value_or(std::byte{0xFF}));
  image.identity = identity_in(begin);
  image.is_whole = is_sealed(image.segments);
  return image;
}

Image read_image(const std::filesystem::path& elf) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(elf, code))
    throw NoImage(fmt::format(
        "The firmware {} does not exist. Build it first (tools/build board), or give another file.", elf.string()));
  if (std::filesystem::file_size(elf, code) > file_maximum)
    throw NoImage(fmt::format("{} is too large to be a firmware.", elf.string()));
  std::ifstream stream(elf, std::ios::binary);
  const std::vector<char> content{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.good() && !stream.eof()) throw NoImage(fmt::format("{} cannot be read.", elf.string()));
  return read_image(std::as_bytes(std::span(content)), elf);
}

std::optional<Image> own_image_for(std::string_view board) {
  const board::Facts* facts = board::find_board(board);
  if (facts == nullptr) return {};
  return read_image(installation::firmware(board::image_name(*facts)));
}

std::string describe(const protocol::ImageIdentity& identity) {
  return fmt::format("firmware {} for {}, protocol {}", version_of(identity), identity.board_name(),
                     identity.protocol_version);
}

std::vector<std::string> objections(const Image& image, const std::optional<protocol::ImageIdentity>& there) {
  const std::string name = image.file.string();
  std::vector<std::string> sentences;
  if (!image.identity) {
    sentences.push_back(
        fmt::format("{} does not state its board: it is not a firmware of Inkwell, or it is an old version.", name));
    return sentences;
  }
  const auto& identity = *image.identity;
  if (there && there->board_name() != identity.board_name())
    sentences.push_back(fmt::format("{} is for the board {}, but this board is {}, whose pins have other functions.",
                                    name, identity.board_name(), there->board_name()));
  if (identity.protocol_version != protocol::protocol_version)
    sentences.push_back(
        fmt::format("{} uses protocol version {}, this companion uses version {}: they are not compatible.", name,
                    identity.protocol_version, protocol::protocol_version));
  if (!image.is_whole)
    sentences.push_back(fmt::format("{} is damaged: its checksum is wrong. Build or copy it again.", name));
  return sentences;
}

std::optional<std::string> downgrade_warning(const Image& image, const std::optional<protocol::ImageIdentity>& there) {
  if (!image.identity || !there || image.identity->version() >= there->version()) return {};
  return fmt::format(
      "{} contains firmware {}, which is older than the installed firmware {}. Defects that were corrected since then "
      "would return.",
      image.file.string(), version_of(*image.identity), version_of(*there));
}

void insist(const Image& image, const std::optional<protocol::ImageIdentity>& there, Consent consent) {
  if (consent == Consent::to_everything) return;
  auto reasons = objections(image, there);
  const bool is_otherwise_fine = reasons.empty();
  if (consent == Consent::none)
    if (auto warning = downgrade_warning(image, there)) reasons.push_back(std::move(*warning));
  if (reasons.empty()) return;
  const auto text = fmt::format("{} Nothing was changed.", fmt::join(reasons, " "));
  if (is_otherwise_fine) throw Downgrade(text);
  throw Objected(text);
}

}  // namespace inkwell::firmware_update
