// Parameters as a TOML file that a person can read, compare and write.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <device/device.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::window {

struct LoadedParameters {
  std::vector<device::ParameterChange> changes;
  /// One sentence for each thing that was passed over: a name this version does not know, another protocol version.
  std::vector<std::string> remarks;
};

/// Reads the table [parameters]; an arm description has it too, and can be loaded as it is.
/// Throws device::Error for damaged TOML and for a value that is no number, not finite or out of range; `name` is
/// how the sentence calls the file.
LoadedParameters parse_parameters(const std::string& text, const std::string& name);
LoadedParameters load_parameters(const std::filesystem::path& path);

/// The file's text: every parameter under its group, with unit, range and default in a comment.
std::string format_parameters(const protocol::ParameterSet& parameters);

/// Writes a new file and then puts it in place of the old one, so that a full disk leaves the old one whole.
/// Throws device::Error.
void save_text(const std::filesystem::path& path, const std::string& text);

}  // namespace inkwell::window
