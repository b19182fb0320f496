// A firmware image, read from its ELF file.
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

#include "host/client/device/error.hpp"
#include "protocol/image_identity.hpp"

namespace inkwell::firmware_update {

/// Thrown if the file is not a program for the flash of an STM32F405.
class NoImage : public device::Error {
 public:
  using Error::Error;
};

enum class Consent : std::uint8_t { none, to_downgrade, to_everything };

/// Thrown if the image does not suit this board and the user has not agreed to write the image. `what()` lists the
/// reasons.
class Objected : public device::Error {
 public:
  using Error::Error;
};

/// Thrown if the only objection is that the image is older than the board's firmware.
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
  std::vector<Segment> segments;                      ///< in flash, by address, without overlap
  std::optional<protocol::ImageIdentity> identity{};  ///< none: not an Inkwell image, or one without an identity
  bool is_whole = false;                              ///< the checksum at its end is correct

  /// Returns the byte at an address, or std::nullopt if the image has no data at this address.
  std::optional<std::byte> at(std::uint32_t address) const;
};

/// Throws NoImage.
Image read_image(const std::filesystem::path& elf);
/// Reads an image from the content of a file; `name` is for error messages.
Image read_image(std::span<const std::byte> elf, const std::filesystem::path& name);

/// Returns the installed firmware for this board name, or std::nullopt if the board is unknown. Throws NoImage if the
/// file is missing.
std::optional<Image> own_image_for(std::string_view board);

/// If the user has not named an image, selects the installed image for this board name. May return none.
using ImageFor = std::function<std::optional<Image>(std::string_view board)>;
inline std::optional<Image> always_the_given(std::string_view) { return {}; }

/// The identity in the first bytes of a flash, if any.
std::optional<protocol::ImageIdentity> identity_in(std::span<const std::byte> begin_of_flash);
/// `identity_in` needs this number of flash bytes.
inline constexpr std::size_t identity_end = protocol::image_identity_offset + sizeof(protocol::ImageIdentity);

/// "firmware 0.1.0 for omni_driver, protocol 11".
std::string describe(const protocol::ImageIdentity& identity);

/// Returns the objections against writing this image, one sentence each. `there` is the identity of the board's current
/// image, if known.
std::vector<std::string> objections(const Image& image, const std::optional<protocol::ImageIdentity>& there);
/// Returns a sentence if the image is older than the installed firmware. An older image causes a warning, not an
/// objection.
std::optional<std::string> downgrade_warning(const Image& image, const std::optional<protocol::ImageIdentity>& there);

/// Throws Objected with the objections, or Downgrade with the warning, unless the user has agreed to them.
void insist(const Image& image, const std::optional<protocol::ImageIdentity>& there, Consent consent);

/// The CRC-32 of the chip's CRC unit (RM0090, chapter CRC), over little-endian words. An incomplete last word is not
/// counted.
class WordChecksum {
 public:
  void add(std::uint32_t word);
  std::uint32_t value() const { return rest_; }

 private:
  std::uint32_t rest_ = 0xFFFF'FFFF;
};

}  // namespace inkwell::firmware_update
