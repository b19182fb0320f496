// A new firmware by a debug probe at the board's SWD connector, through openocd.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <firmware_update/image.hpp>

namespace inkwell::firmware_update {

/// Whether it can be the name of one of openocd's interface files, such as "stlink": lower-case letters, digits, '_'
/// and '-' only, so that it cannot lead into another folder.
bool is_interface_name(std::string_view name);
/// The sentence for a user who gave another name.
std::string no_interface_name(std::string_view name);

/// Bytes of the image as Intel HEX, which openocd reads in place of the user's file: nothing else is written.
std::string intel_hex(const Image& image);

/// Arguments of openocd, which copies the first bytes of the flash into `installed_file` while the firmware runs on.
std::vector<std::string> openocd_arguments_for_reading(const std::string& interface);
/// Arguments of openocd, which writes the sectors of the image, reads them back, prints `verified_line`, sets the
/// brown-out level if it differs, and starts the firmware.
std::vector<std::string> openocd_arguments_for_writing(const std::string& interface);
inline constexpr char installed_file[] = "installed.bin", image_file[] = "image.hex",
                      verified_line[] = "inkwell: the image is verified";

/// Runs openocd in a private folder, because openocd looks for its scripts in its current folder first. Without
/// consent to everything, a first run reads the identity of the installed firmware. `on_line` gets each line that
/// openocd prints. Throws Objected and Downgrade as `update` does, and device::Error if there is no openocd, it fails,
/// or it does not report that the image is verified.
void update_by_probe(const Image& image, const std::string& interface, Consent consent,
                     const std::function<void(const std::string&)>& on_line);

}  // namespace inkwell::firmware_update
