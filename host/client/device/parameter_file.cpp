#include "host/client/device/parameter_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "host/client/device/nearest_name.hpp"
#include "host/client/local/replaced_file.hpp"
#include "protocol/plain_text.hpp"

namespace inkwell::device {
namespace {

using protocol::Parameter;
using protocol::ParameterKind;

std::string range_text(Parameter parameter) {
  const auto& row = info(parameter);
  return fmt::format("{} to {}{}{}", format_value(parameter, row.minimum), format_value(parameter, row.maximum),
                     row.unit.empty() ? "" : " ", row.unit);
}

/// Returns a TOML string.
std::string quoted(const std::string& text) {
  std::ostringstream stream;
  stream << toml::value<std::string>(text);
  return stream.str();
}

std::string described(const ParameterOrigin& origin) {
  return origin.board_name.empty() ? origin.serial_number
                                   : fmt::format("{} on the board {}", origin.serial_number, origin.board_name);
}

}  // namespace

std::string format_value(Parameter parameter, float value) {
  std::string text = fmt::format("{}", value);
  const bool is_real = info(parameter).kind == ParameterKind::real;
  if (is_real && text.find_first_of(".en") == std::string::npos) text += ".0";
  if (!is_real && text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

std::string parameter_suggestion(std::string_view name) { return suggestion(protocol::known_parameters(), name); }

Parameter parameter_named(std::string_view name) {
  if (const auto parameter = protocol::find_parameter(name)) return *parameter;
  throw UnknownName(fmt::format("There is no parameter {}.{} `inkwell parameters` lists them all.", name,
                                parameter_suggestion(name)));
}

void check_value(Parameter parameter, float value) {
  const auto& row = info(parameter);
  if (!std::isfinite(value) || value < row.minimum || value > row.maximum)
    throw Error(
        fmt::format("{} = {} is outside its range. Give a number from {}.", row.name, value, range_text(parameter)));
  if (row.kind != ParameterKind::real && value != std::round(value))
    throw Error(fmt::format("{} = {} must be a whole number. Give a whole number from {}.", row.name, value,
                            range_text(parameter)));
}

std::optional<float> parse_number(std::string_view text) {
  float value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

float parse_value(Parameter parameter, std::string_view number) {
  const auto value = parse_number(number);
  if (!value) {
    const bool has_comma = number.find(',') != std::string_view::npos;
    throw Error(fmt::format("`{}` is not a number. Give {} a number from {}{}.", number, info(parameter).name,
                            range_text(parameter), has_comma ? ", with a decimal point and without commas" : ""));
  }
  check_value(parameter, *value);
  return *value;
}

ParameterChange parse_change(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos)
    throw Error(fmt::format("`{}` is not of the form NAME=VALUE. Write for example wall_stiffness_N_per_m=900.", text));
  const Parameter parameter = parameter_named(text.substr(0, equals));
  return {parameter, parse_value(parameter, text.substr(equals + 1))};
}

ParameterFile parse_parameters(std::string_view toml_text, const std::string& file_name) {
  toml::table document;
  try {
    document = toml::parse(toml_text, file_name);
  } catch (const toml::parse_error& error) {
    throw Error(
        fmt::format("{}, line {}: {}. Correct that line.", file_name, error.source().begin.line, error.description()));
  }
  const toml::table* section = document["parameters"].as_table();
  if (section == nullptr)
    throw Error(fmt::format(
        "{} has no [parameters] section. Create a parameter file with `inkwell parameters save FILE`.", file_name));

  ParameterFile file;
  const auto origin = std::as_const(document)["saved_from"];
  file.origin = {protocol::plain_text(origin["serial_number"].value_or(std::string_view())),
                 protocol::plain_text(origin["board"].value_or(std::string_view()))};
  for (const auto& [key, node] : *section) {
    const auto parameter = protocol::find_parameter(key.str());
    if (!parameter) {
      file.unknown.push_back(protocol::plain_text(key.str()));
      continue;
    }
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    if (!number)
      throw Error(fmt::format("{}, line {}: {} is not a number. Give a number from {}.", file_name,
                              node.source().begin.line, key.str(), range_text(*parameter)));
    const auto value = static_cast<float>(*number);
    try {
      check_value(*parameter, value);
    } catch (const Error& error) {
      throw Error(fmt::format("{}, line {}: {}", file_name, node.source().begin.line, error.what()));
    }
    file.changes.emplace_back(*parameter, value);
  }
  std::sort(file.changes.begin(), file.changes.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return file;
}

ParameterFile load_parameters(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!std::filesystem::is_regular_file(file) || !stream || !(text << stream.rdbuf()))
    throw Error(fmt::format("The file {} cannot be read. Check its name and your permission.", file.string()));
  return parse_parameters(text.str(), file.string());
}

std::string format_parameters(const protocol::ParameterSet& parameters, const ParameterOrigin& origin) {
  std::string text = fmt::format(
      "# Parameters of an Inkwell haptic arm. `inkwell parameters load FILE` sends them to the "
      "device.\n\nprotocol_version = {}\n",
      protocol::protocol_version);
  if (origin != ParameterOrigin{})
    text += fmt::format("\n[saved_from]\nserial_number = {}\nboard = {}\n", quoted(origin.serial_number),
                        quoted(origin.board_name));
  text += "\n[parameters]\n";
  std::string_view group;
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i) {
    const auto parameter = static_cast<Parameter>(i);
    const auto& row = info(parameter);
    if (row.group != group) text += fmt::format("\n# ---- {} ----\n", row.group);
    group = row.group;
    const std::string entry = fmt::format("{} = {}", row.name, format_value(parameter, parameters.values[i]));
    text += fmt::format("{:<44} # {}: {}\n", entry, range_text(parameter), row.help);
  }
  return text;
}

void save_parameters(const std::filesystem::path& file, const protocol::ParameterSet& parameters,
                     const ParameterOrigin& origin) {
  try {
    local::replace_file(file, format_parameters(parameters, origin));
  } catch (const std::system_error& error) {
    throw Error(fmt::format("The file {} cannot be written: {}. Check the folder, your permission and the free space.",
                            file.string(), error.code().message()));
  }
}

std::vector<ParameterDifference> compare(const ParameterFile& file, const protocol::ParameterSet& device) {
  std::vector<ParameterDifference> differences;
  for (const auto& [parameter, value] : file.changes)
    if (device[parameter] != value) differences.push_back({parameter, value, device[parameter]});
  return differences;
}

std::vector<ParameterDifference> compare_arm(const ParameterFile& file, const protocol::ParameterSet& device) {
  auto differences = compare(file, device);
  // Users change the box for each task, although every arm description contains a box.
  std::erase_if(differences, [](const ParameterDifference& difference) {
    const auto& row = info(difference.parameter);
    return !row.belongs_to_arm || row.group == "box";
  });
  return differences;
}

ParameterOrigin origin_of(const Information& information) {
  return {information.serial_number, information.board_name};
}

std::string origin_text(const ParameterOrigin& file, const ParameterOrigin& device) {
  if (file.serial_number.empty()) return "The file does not state the arm of its values.";
  if (file == device) return "The file was saved from this arm.";
  return fmt::format("The file was saved from the arm {}. This arm is {}.", described(file), described(device));
}

std::string difference_text(const ParameterDifference& difference) {
  const auto& row = info(difference.parameter);
  return fmt::format("{:<34} file {:>12}   device {:>12} {}", row.name,
                     format_value(difference.parameter, difference.in_file),
                     format_value(difference.parameter, difference.in_device), row.unit);
}

}  // namespace inkwell::device
