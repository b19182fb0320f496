// Firmware update through a debug probe at the board's SWD connector, with openocd.
#pragma once

#include <filesystem>
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

struct DebugProbe {
  std::string interface = "stlink";                            ///< name of an openocd interface file
  std::string serial_number{};                                 ///< empty: the only connected probe
  std::filesystem::path usb_devices = "/sys/bus/usb/devices";  ///< the system's list of USB devices; tests replace it
};

/// Returns the serial numbers of the connected probes with this interface. Returns an empty list if the system does not
/// list USB devices, or if probes with this interface cannot be recognized.
std::vector<std::string> serial_numbers_of_probes(const DebugProbe& probe);

/// openocd reads these bytes instead of the user's file, and therefore writes nothing else.
std::string intel_hex(const Image& image);

/// Returns the arguments of openocd that copy the first bytes of the flash to `installed_file`. The firmware continues
/// to run.
std::vector<std::string> openocd_arguments_for_reading(const DebugProbe& probe);
/// Returns the arguments with which openocd writes the sectors of the image, reads them back, and prints
/// `verified_line`. The arguments also set the brown-out level, if necessary, and start the firmware.
std::vector<std::string> openocd_arguments_for_writing(const DebugProbe& probe);
inline constexpr char installed_file[] = "installed.bin", image_file[] = "image.hex",
                      verified_line[] = "inkwell: the image is verified";

/// Runs openocd in a private folder, because openocd searches for scripts in its current folder first. Without
/// Consent::to_everything, a first run reads the identity of the installed firmware. `on_line` receives each line that
/// openocd prints. Throws Objected and Downgrade like `update`. Throws device::Error if openocd is missing, fails, or
/// does not report that the image is verified, and if several probes are connected and none is chosen.
void update_by_probe(const Image& image, const DebugProbe& probe, Consent consent,
                     const std::function<void(const std::string&)>& on_line);

}  // namespace inkwell::firmware_update
