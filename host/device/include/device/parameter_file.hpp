// Parameters as TOML files that a person can read and compare. An arm description (boards/arms/*.toml) is one too:
// its other sections are left alone.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <device/device.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::device {

struct ParameterFile {
  std::vector<ParameterChange> changes;  ///< in the table's order
  std::vector<std::string> unknown;      ///< names in the file that this version does not know
};

struct ParameterDifference {
  protocol::Parameter parameter;
  float in_file;
  float in_device;
};

/// Reads the [parameters] section. Throws Error naming the line or the key if it is not TOML, a value is no number
/// or lies outside its range. Unknown names are returned, not refused: files of other versions stay usable.
ParameterFile parse_parameters(std::string_view toml, const std::string& file_name);
ParameterFile load_parameters(const std::filesystem::path& file);

/// Every parameter under its group, with unit, range and help beside it.
std::string format_parameters(const protocol::ParameterSet& parameters);
/// Writes beside the file first and then renames, so that a full disk does not cost the old file.
void save_parameters(const std::filesystem::path& file, const protocol::ParameterSet& parameters);

std::vector<ParameterDifference> compare(const ParameterFile& file, const protocol::ParameterSet& device);

/// The shortest text that reads back as exactly this value.
std::string format_value(protocol::Parameter parameter, float value);
/// None if the text is anything but a number, such as one with a comma.
std::optional<float> parse_number(std::string_view text);
/// A value as a person types it, with a decimal point. Throws Error with a sentence if it is no number or not in range.
float parse_value(protocol::Parameter parameter, std::string_view number);
/// "NAME=VALUE". Throws Error with the nearest name, or the range, if it cannot be meant.
ParameterChange parse_change(std::string_view text);
/// Throws Error, with the nearest name if one is near, if there is none of this name.
protocol::Parameter parameter_named(std::string_view name);
/// " Did you mean NAME?" with a known name that is near; empty if none is.
std::string parameter_suggestion(std::string_view name);
/// Throws Error that says the range if the value is not finite, outside it, or not whole where it must be.
void check_value(protocol::Parameter parameter, float value);

}  // namespace inkwell::device
