// A new firmware by a debug probe at the board's SWD connector, through openocd.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <firmware_update/image.hpp>

namespace inkwell::firmware_update {

/// What openocd is to be called with: it writes the image's own sectors, reads them back, sets the brown-out level if
/// it differs, and starts the firmware. `interface` is the name of one of openocd's interface files, such as stlink.
std::vector<std::string> openocd_arguments(const std::filesystem::path& image, const std::string& interface);

/// Runs openocd, which says what it does. Throws Objected as `update` does, and device::Error if there is no openocd or
/// it does not succeed.
void update_by_probe(const Image& image, const std::string& interface, Consent consent);

}  // namespace inkwell::firmware_update
