// The flash file of a virtual board that is not running (`virtual-board --flash`).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/client/firmware_update/image.hpp"

namespace inkwell::firmware_update {

/// Writes the image like a flash programmer, which erases only the sectors of the image. A missing file is created with
/// the flash of a new chip. Throws Objected or device::Error and leaves the file unchanged, for example while a board
/// uses the file.
struct FlashFileWritten {
  std::optional<protocol::ImageIdentity> before;  ///< none: the file contained no image with an identity
  Image image;
  std::string warning;  ///< a warning for the user, or empty
};
FlashFileWritten write_flash_file(const std::filesystem::path& file, const Image& image, Consent consent,
                                  const ImageFor& image_for = always_the_given);

}  // namespace inkwell::firmware_update
