// The flash of a virtual board that does not run, in the file that `virtual-board --flash` keeps it in.
#pragma once

#include <filesystem>

#include <firmware_update/image.hpp>

namespace inkwell::firmware_update {

/// Writes the image as a programmer does: its own sectors are erased, the others stay. A file that is not there becomes
/// a new chip's flash. Returns what the file held before. Throws Objected, or device::Error with the file as it was.
std::optional<protocol::ImageIdentity> write_flash_file(const std::filesystem::path& file, const Image& image,
                                                        bool says_yes);

}  // namespace inkwell::firmware_update
