#include <window/parameter_file.hpp>

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <system_error>
#include <toml++/toml.h>

#include <protocol/reports.hpp>

namespace inkwell::window {

using device::Error;

namespace {

toml::table parse_toml(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    throw Error(fmt::format("{} is not valid TOML: line {}, column {}: {}. Correct that line.", name, begin.line,
                            begin.column, error.description()));
  }
}

float number_in_range(const toml::node& node, const protocol::ParameterInfo& info, const std::string& name) {
  const auto number = node.value<double>();
  if (!number || node.is_boolean())
    throw Error(fmt::format("{}: {} must be a number.", name, info.name));
  const auto value = static_cast<float>(*number);
  if (!std::isfinite(value) || value < info.minimum || value > info.maximum)
    throw Error(fmt::format("{}: {} = {} is outside its range of {} to {} {}. Nothing was loaded.", name, info.name,
                            *number, info.minimum, info.maximum, info.unit));
  if (info.kind != protocol::ParameterKind::real && value != std::round(value))
    throw Error(fmt::format("{}: {} = {} must be a whole number. Nothing was loaded.", name, info.name, *number));
  return value;
}

}  // namespace

LoadedParameters parse_parameters(const std::string& text, const std::string& name) {
  const toml::table file = parse_toml(text, name);
  const toml::table* parameters = file["parameters"].as_table();
  if (parameters == nullptr)
    throw Error(fmt::format("{} has no table [parameters], so it is no file of parameters.", name));

  LoadedParameters loaded;
  if (const auto version = file["file"]["protocol_version"].value<std::int64_t>();
      version && *version != protocol::protocol_version)
    loaded.remarks.push_back(fmt::format("The file was written for protocol version {}, this is version {}.", *version,
                                         protocol::protocol_version));
  for (const auto& [key, node] : *parameters) {
    const auto parameter = protocol::find_parameter(key.str());
    if (!parameter) {
      loaded.remarks.push_back(fmt::format("This version does not know the parameter {}; it was left out.", key.str()));
      continue;
    }
    loaded.changes.emplace_back(*parameter, number_in_range(node, protocol::info(*parameter), name));
  }
  return loaded;
}

LoadedParameters load_parameters(const std::filesystem::path& path) {
  std::ifstream stream(path);
  if (!stream) throw Error(fmt::format("The file {} cannot be read: {}.", path.string(), std::generic_category().message(errno)));
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_parameters(text.str(), path.filename().string());
}

std::string format_parameters(const protocol::ParameterSet& parameters) {
  std::string text = fmt::format(
      "# Parameters of an Inkwell device.\n\n[file]\nprotocol_version = {}\n\n[parameters]\n", protocol::protocol_version);
  std::string_view group;
  for (std::size_t i = 0; i < protocol::parameter_count; ++i) {
    const auto& info = protocol::parameter_table[i];
    if (info.group != group) {
      group = info.group;
      text += fmt::format("\n# {}\n", group);
    }
    text += fmt::format("{:<40}# {}{}{} to {}, default {}\n", fmt::format("{} = {}", info.name, parameters.values[i]),
                        info.unit, info.unit.empty() ? "" : ", ", info.minimum, info.maximum, info.default_value);
  }
  return text;
}

void save_text(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path unfinished = path.string() + ".new";
  {
    std::ofstream stream(unfinished, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) {
      std::error_code ignored;
      std::filesystem::remove(unfinished, ignored);
      throw Error(fmt::format("The file {} cannot be written. Check that the folder exists, may be written and the "
                              "disk is not full; nothing was changed.", path.string()));
    }
  }
  std::error_code error;
  std::filesystem::rename(unfinished, path, error);
  if (error) throw Error(fmt::format("The file {} cannot be replaced: {}.", path.string(), error.message()));
}

}  // namespace inkwell::window
