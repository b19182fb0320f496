// The flash of a virtual board that does not run, in the file that `virtual-board --flash` keeps it in.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <firmware_update/image.hpp>

namespace inkwell::firmware_update {

/// Writes the image as a programmer does: its own sectors are erased, the others stay. A file that is not there becomes
/// a new chip's flash. Throws Objected, or device::Error with the file as it was, as while a board runs on it.
struct FlashFileWritten {
  std::optional<protocol::ImageIdentity> before;  ///< none: the file held no image that says what it is
  Image image;
  std::string warning;  ///< empty, or what to take care of
};
FlashFileWritten write_flash_file(const std::filesystem::path& file, const Image& image, Consent consent,
                                  const ImageFor& image_for = always_the_given);

}  // namespace inkwell::firmware_update
