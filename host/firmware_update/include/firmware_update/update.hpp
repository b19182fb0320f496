// The whole way of a new firmware into a board on USB: out of the firmware that runs, through the boot loader in the
// chip, and back.
//
// The order keeps a half-written firmware from ever running: the first sector, with the vector table, is erased before
// anything else and its first block written after everything else was read back. Between these two the chip finds no
// vectors, so after a power-off it does nothing at all; bridges stay off by their pull-downs. As long as its power is
// on it stays in the boot loader, and the same command again goes on from there. After a power-off only BOOT0 leads
// there.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <device/address.hpp>
#include <firmware_update/boot_loader.hpp>
#include <firmware_update/image.hpp>

namespace inkwell::firmware_update {

/// Cut off with the old firmware gone and the new one not complete. `what()` says how to go on.
class Interrupted : public device::Error {
 public:
  using Error::Error;
};

struct UpdateOptions {
  Consent consent = Consent::none;
  ImageFor image_for = always_the_given;
  /// Called with each step, and how much of all is done, from 0 to 1.
  std::function<void(std::string_view step, double done)> on_progress = [](std::string_view, double) {};
  /// Asked between two blocks.
  std::function<bool()> is_cancelled = [] { return false; };
};

struct UpdateResult {
  std::optional<protocol::ImageIdentity> before;  ///< none: the board held no image that says what it is
  Image written;
  bool has_set_brown_out = false;
  std::string serial_number;  ///< of the arm that came back; empty if none did in time
  std::string firmware_version;
  std::uint16_t protocol_version = 0;
};

/// From the board that the address means, running or in its boot loader. Throws Objected, Interrupted, or device::Error
/// where the board is as it was.
UpdateResult update(const device::Address& address, const Image& image, const UpdateOptions& options);

/// The same for a board that is in its boot loader already, up to its start.
struct Written {
  std::optional<protocol::ImageIdentity> before;
  Image image;
  bool has_set_brown_out = false;
};
Written write_image(BootLoader& loader, const Image& image, const UpdateOptions& options);

/// Option bytes with brown-out level 3 (RM0090, "Description of the option bytes": BOR_LEV), or nothing if they have
/// it. Throws device::Error if they are none of a chip whose protection is off.
std::optional<std::array<std::byte, BootLoader::option_bytes>> with_brown_out_level_3(
    const std::array<std::byte, BootLoader::option_bytes>& options);

}  // namespace inkwell::firmware_update
