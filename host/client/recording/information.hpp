// Metadata of a recording: device, firmware, arm, parameters and columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "host/client/device/device.hpp"
#include "protocol/parameters.hpp"
#include "protocol/signals.hpp"
#include "protocol/simulation.hpp"

namespace inkwell::recording {

/// Increases when the layout of the files changes.
inline constexpr int format_version = 1;
inline constexpr char format_name[] = "inkwell recording";

struct Information {
  std::string name;         ///< chosen by the user; empty: none
  std::string note;         ///< text of the user in one line; empty: none
  std::string created_utc;  ///< ISO 8601 with microseconds
  /// Version of the library or program that recorded, and SHA-256 of its file in hexadecimal digits.
  std::string library_version, library_sha256;
  /// SHA-256 of the firmware image and of the arm description; empty if the files are unknown, as for a board on USB.
  std::string image_sha256, arm_sha256;
  /// Checksum of the firmware image on the board, in hexadecimal digits, as in `inkwell info`; empty: not reported.
  std::string image_check;
  std::string firmware_version;
  std::uint16_t protocol_version = protocol::protocol_version;
  std::string serial_number;
  std::string arm;  ///< name of the arm, if known
  bool simulation = false;
  /// The device's protocol::ForceLawReport: rows of parameters and signals in addition to the tables. Null if unknown.
  std::shared_ptr<const std::vector<std::byte>> force_law;
  /// A parameter that an older recording does not contain has its default.
  protocol::ParameterSet parameters = protocol::default_parameters();
  std::vector<protocol::Signal> signals;
  /// Control periods from one sample to the next: 1 for the scope, more for a black box.
  std::uint32_t step_periods = 1;
  /// Simulated quantities in addition to the signals. A device does not send simulated quantities, so a replay ignores
  /// them.
  std::vector<protocol::SimulatedQuantity> simulated;
};

/// Texts of the user, and files that determine the content of a recording.
struct Origin {
  std::string name, note;
  std::filesystem::path image, arm_description;  ///< empty: unknown
};

/// Returns the metadata for a recording that starts now. If `arm` is empty and the parameters match the default arm,
/// its name is used.
Information describe(const device::Information& device, const protocol::ParameterSet& parameters,
                     std::vector<protocol::Signal> signals, const std::string& arm, bool simulation,
                     const Origin& origin = {});

}  // namespace inkwell::recording
