// An image of the firmware, from its ELF.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <device/error.hpp>
#include <protocol/image_identity.hpp>

namespace inkwell::firmware_update {

/// A file that is no program for the flash of an STM32F405.
class NoImage : public device::Error {
 public:
  using Error::Error;
};

/// What the user has agreed to.
enum class Consent : std::uint8_t { none, to_downgrade, to_everything };

/// The image should not go into this board, and the user has not agreed to it. `what()` holds the reasons.
class Objected : public device::Error {
 public:
  using Error::Error;
};

/// The only reason is that the image is older than the board's firmware.
class Downgrade : public Objected {
 public:
  using Objected::Objected;
};

struct Segment {
  std::uint32_t address;
  std::vector<std::byte> bytes;
  std::uint32_t end() const { return address + static_cast<std::uint32_t>(bytes.size()); }
};

struct Image {
  std::filesystem::path file;
  std::vector<Segment> segments;                      ///< of the flash, by address, none reaching into another
  std::optional<protocol::ImageIdentity> identity{};  ///< none: it is not Inkwell's, or older than these
  bool is_whole = false;                              ///< the checksum at its end is that of its words

  /// The byte at an address, none where the image has nothing.
  std::optional<std::byte> at(std::uint32_t address) const;
};

/// Throws NoImage.
Image read_image(const std::filesystem::path& elf);
/// The same of a file's content; `name` is for sentences.
Image read_image(std::span<const std::byte> elf, const std::filesystem::path& name);

/// The firmware beside this program for the board of this name, or nothing if none is known here by it. Throws NoImage
/// if it is missing.
std::optional<Image> own_image_for(std::string_view board);

/// In the place of an image that nobody has named: what the board of this name gets, or nothing.
using ImageFor = std::function<std::optional<Image>(std::string_view board)>;
inline std::optional<Image> always_the_given(std::string_view) { return {}; }

/// The identity in the first bytes of a flash, if one is there.
std::optional<protocol::ImageIdentity> identity_in(std::span<const std::byte> begin_of_flash);
/// Bytes of a flash that `identity_in` wants.
inline constexpr std::size_t identity_end = protocol::image_identity_offset + sizeof(protocol::ImageIdentity);

/// "firmware 0.1.0 for omni_driver, protocol 11".
std::string describe(const protocol::ImageIdentity& identity);

/// Why this image should not go into a board, a sentence each; none if it should. `there` is the identity of the image
/// that the board has, if it has one.
std::vector<std::string> objections(const Image& image, const std::optional<protocol::ImageIdentity>& there);
/// Returns a sentence if the image is older than the installed firmware. This is a warning and not an objection.
std::optional<std::string> downgrade_warning(const Image& image, const std::optional<protocol::ImageIdentity>& there);

/// Throws Objected with the objections, or Downgrade with the warning, unless the user has agreed to them.
void insist(const Image& image, const std::optional<protocol::ImageIdentity>& there, Consent consent);

/// The CRC-32 that the chip counts (RM0090, chapter CRC), of little-endian words; what is left of a word is not
/// counted.
class WordChecksum {
 public:
  void add(std::uint32_t word);
  std::uint32_t value() const { return rest_; }

 private:
  std::uint32_t rest_ = 0xFFFF'FFFF;
};

}  // namespace inkwell::firmware_update
