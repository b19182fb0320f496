// Updates the firmware over USB with the boot loader of the chip.
//
// The order of the steps ensures that an incomplete firmware never runs. The first sector contains the vector table and
// is erased first. The first block is written last, after all other blocks were verified. Until the last write, the
// flash contains no vectors. After a power loss the chip then runs no code, and the pull-downs keep the bridges off.
// While the power is on, the chip stays in the boot loader, and repeating the command continues the update. After a
// power loss the boot loader starts only if BOOT0 is high.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "host/client/device/address.hpp"
#include "host/client/firmware_update/boot_loader.hpp"
#include "host/client/firmware_update/image.hpp"

namespace inkwell::firmware_update {

/// Thrown if the update stops after the old firmware was erased and before the new firmware is complete. `what()`
/// describes how to continue.
class Interrupted : public device::Error {
 public:
  using Error::Error;
};

struct UpdateOptions {
  Consent consent = Consent::none;
  ImageFor image_for = always_the_given;
  /// Receives each step and the completed fraction, 0 to 1.
  std::function<void(std::string_view step, double done)> on_progress = [](std::string_view, double) {};
  /// Called between two blocks.
  std::function<bool()> is_cancelled = [] { return false; };
};

struct UpdateResult {
  std::optional<protocol::ImageIdentity> before;  ///< none: the board had no image with an identity
  Image written;
  bool has_set_brown_out = false;
  std::string serial_number;  ///< of the arm after the update; empty if no arm appeared in time
  std::string firmware_version;
  std::uint16_t protocol_version = 0;
};

/// Updates the board at the address. The firmware or the boot loader of the board must be running. Throws Objected,
/// Interrupted, or, if the board is unchanged, device::Error.
UpdateResult update(const device::Address& address, const Image& image, const UpdateOptions& options);

/// Continues an update in the boot loader until the new firmware starts.
struct Written {
  std::optional<protocol::ImageIdentity> before;
  Image image;
  bool has_set_brown_out = false;
};
Written write_image(BootLoader& loader, const Image& image, const UpdateOptions& options);

/// The option bytes with brown-out level 3 (RM0090, "Description of the option bytes": BOR_LEV), or none if the level
/// is already 3. Throws device::Error if the option bytes do not show a chip without read protection.
std::optional<std::array<std::byte, BootLoader::option_bytes>> with_brown_out_level_3(
    const std::array<std::byte, BootLoader::option_bytes>& options);

}  // namespace inkwell::firmware_update
