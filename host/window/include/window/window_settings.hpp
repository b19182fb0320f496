// What the window remembers from one time to the next: a TOML file in the user's configuration directory.
#pragma once

#include <filesystem>
#include <string>

#include <frame/palette.hpp>
#include <scope/scope_settings.hpp>

namespace inkwell::window {

struct WindowSettings {
  static constexpr float column_width_minimum = 300.0f;
  static constexpr float scope_height_minimum = 150.0f;
  static constexpr float scope_part_minimum = 0.1f;
  static constexpr float scope_part_maximum = 0.9f;

  Theme theme = Theme::dark;
  float column_width = 330.0f;  ///< of the panes at the right; in points, before scaling
  float scope_part = 0.42f;     ///< of the height that scene and scope share
  bool scope_is_shown = true;
  ScopeSettings scope;
  std::filesystem::path parameters_file;  ///< the one loaded or saved last
  bool operator==(const WindowSettings&) const = default;
};

/// $XDG_CONFIG_HOME/inkwell/window.toml, or the same below ~/.config; empty if neither is known.
std::filesystem::path window_settings_path();

/// As they were kept; the defaults if there is no such file.
WindowSettings read_settings(const std::filesystem::path& file);
/// A sentence about why they could not be kept; empty if they were.
std::string write_settings(const WindowSettings& settings, const std::filesystem::path& file);

std::string format_settings(const WindowSettings& settings);
/// What cannot be read, or makes no sense, keeps its default: a damaged file of settings must not keep the window shut.
WindowSettings parse_settings(const std::string& text);

}  // namespace inkwell::window
