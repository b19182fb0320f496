// Reads and writes parameters in TOML files. A parameter file may also be an arm description.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/device.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::device {

/// The arm and the board whose parameters a file contains. Empty texts are unknown.
struct ParameterOrigin {
  std::string serial_number;
  std::string board_name;
  bool operator==(const ParameterOrigin&) const = default;
};

struct ParameterFile {
  std::vector<ParameterChange> changes;  ///< in the order of the table
  std::vector<std::string> unknown;      ///< names that this version does not define
  ParameterOrigin origin;
};

struct ParameterDifference {
  protocol::Parameter parameter;
  float in_file;
  float in_device;
};

/// Reads the [parameters] section. Throws Error with the line or key if the file is not TOML or a value is not a number
/// in the allowed range. Returns unknown names, because other versions may define them.
ParameterFile parse_parameters(std::string_view toml, const std::string& file_name);
ParameterFile load_parameters(const std::filesystem::path& file);

/// Formats all parameters by group. Comments state unit, range and help.
std::string format_parameters(const protocol::ParameterSet& parameters, const ParameterOrigin& origin = {});
/// Writes a temporary file and renames it. A full disk therefore does not destroy the old file.
void save_parameters(const std::filesystem::path& file, const protocol::ParameterSet& parameters,
                     const ParameterOrigin& origin = {});

std::vector<ParameterDifference> compare(const ParameterFile& file, const protocol::ParameterSet& device);
/// Returns the differences in geometry, directions, motors and calibration. These values belong to one arm, so a file
/// overwrites them only if the user agrees.
std::vector<ParameterDifference> compare_arm(const ParameterFile& file, const protocol::ParameterSet& device);
/// Returns the origin of the device's parameters.
ParameterOrigin origin_of(const Information& information);
/// Returns a sentence that states whether the file belongs to this arm.
std::string origin_text(const ParameterOrigin& file, const ParameterOrigin& device);
/// Returns a line with the name, both values and the unit.
std::string difference_text(const ParameterDifference& difference);

/// Returns the shortest text that represents this value exactly.
std::string format_value(protocol::Parameter parameter, float value);
/// Returns std::nullopt if the text is not a number with a decimal point.
std::optional<float> parse_number(std::string_view text);
/// Parses a value with a decimal point. Throws Error if the value is not a number in the allowed range.
float parse_value(protocol::Parameter parameter, std::string_view number);
/// Parses "NAME=VALUE". Throws Error with the most similar name or with the allowed range.
ParameterChange parse_change(std::string_view text);
/// Throws Error with the most similar name if no parameter has this name.
protocol::Parameter parameter_named(std::string_view name);
/// Returns " Did you mean NAME?" with the most similar name, or an empty text.
std::string parameter_suggestion(std::string_view name);
/// Throws Error with the allowed range if a value is not allowed.
void check_value(protocol::Parameter parameter, float value);

}  // namespace inkwell::device
