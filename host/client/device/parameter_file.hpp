// Parameters as TOML files for users to read and compare. Arm descriptions (boards/arms/*.toml) are also accepted;
// their other sections are ignored.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/device.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::device {

struct ParameterFile {
  std::vector<ParameterChange> changes;  ///< in the order of the table
  std::vector<std::string> unknown;      ///< names that this version does not know
};

struct ParameterDifference {
  protocol::Parameter parameter;
  float in_file;
  float in_device;
};

/// Reads the [parameters] section. Throws Error with the line or key if the file is not TOML, or a value is not a
/// number or is out of range. Unknown names are returned, so that files of other versions remain usable.
ParameterFile parse_parameters(std::string_view toml, const std::string& file_name);
ParameterFile load_parameters(const std::filesystem::path& file);

/// Lists all parameters by group. Comments state their unit, range and help.
std::string format_parameters(const protocol::ParameterSet& parameters);
/// Writes a temporary file first and then renames it, so that a full disk does not destroy the old file.
void save_parameters(const std::filesystem::path& file, const protocol::ParameterSet& parameters);

std::vector<ParameterDifference> compare(const ParameterFile& file, const protocol::ParameterSet& device);

/// Returns the shortest text that parses to exactly this value.
std::string format_value(protocol::Parameter parameter, float value);
/// None if the text is not a number with a decimal point.
std::optional<float> parse_number(std::string_view text);
/// Parses a value with a decimal point. Throws Error if the text is not a number or is out of range.
float parse_value(protocol::Parameter parameter, std::string_view number);
/// Parses "NAME=VALUE". Throws Error with the most similar name or with the allowed range if the text is invalid.
ParameterChange parse_change(std::string_view text);
/// Throws Error if no parameter has this name. The error contains the most similar name, if any.
protocol::Parameter parameter_named(std::string_view name);
/// " Did you mean NAME?" with a similar known name; empty if there is none.
std::string parameter_suggestion(std::string_view name);
/// Throws Error with the range if the value is not finite, is out of range, or is a fraction for an integer parameter.
void check_value(protocol::Parameter parameter, float value);

}  // namespace inkwell::device
