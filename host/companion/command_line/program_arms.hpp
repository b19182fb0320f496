// Selects the arms of a program for `inkwell run`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/client/command_line/connection.hpp"
#include "host/client/local/private_folder.hpp"

namespace inkwell::command_line {

/// Virtual boards run as long as this object exists.
struct ProgramArms {
  std::vector<device::OpenArm> boards{};
  std::optional<local::PrivateFolder> names_folder{};
};

/// Opens each arm once, so that a missing arm is reported before the program starts, and prints the arms. Sets
/// INKWELL_DEVICE and INKWELL_ARMS for the program.
/// @param names  names with commas between them; with a virtual board also their number; or empty for one arm
/// @throws UsageError, Error
ProgramArms open_program_arms(const DeviceOptions& options, const std::string& names);

}  // namespace inkwell::command_line
