// Firmware update through a debug probe at the board's SWD connector, with openocd.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/firmware_update/image.hpp"

namespace inkwell::firmware_update {

/// Returns true if this is a valid name of an openocd interface file, such as "stlink". Only lower-case letters,
/// digits, '_' and '-' are allowed, so that the name cannot lead to another folder.
bool is_interface_name(std::string_view name);
/// Returns the error sentence for an invalid name.
std::string no_interface_name(std::string_view name);

/// openocd reads these bytes instead of the user's file, and therefore writes nothing else.
std::string intel_hex(const Image& image);

/// Returns the arguments of openocd that copy the first bytes of the flash to `installed_file`. The firmware continues
/// to run.
std::vector<std::string> openocd_arguments_for_reading(const std::string& interface);
/// Returns the arguments with which openocd writes the sectors of the image, reads them back, and prints
/// `verified_line`. The arguments also set the brown-out level, if necessary, and start the firmware.
std::vector<std::string> openocd_arguments_for_writing(const std::string& interface);
inline constexpr char installed_file[] = "installed.bin", image_file[] = "image.hex",
                      verified_line[] = "inkwell: the image is verified";

/// Runs openocd in a private folder, because openocd searches for scripts in its current folder first. Without
/// Consent::to_everything, a first run reads the identity of the installed firmware. `on_line` receives each line that
/// openocd prints. Throws Objected and Downgrade like `update`. Throws device::Error if openocd is missing, fails, or
/// does not report that the image is verified.
void update_by_probe(const Image& image, const std::string& interface, Consent consent,
                     const std::function<void(const std::string&)>& on_line);

}  // namespace inkwell::firmware_update
