// Saved settings of the window: a TOML file in the user's configuration directory.
#pragma once

#include <filesystem>
#include <string>

#include "host/companion/window/frame/palette.hpp"
#include "host/companion/window/scope/scope_settings.hpp"

namespace inkwell::window {

struct WindowSettings {
  static constexpr float column_width_minimum = 300.0f;
  static constexpr float scope_height_minimum = 150.0f;
  static constexpr float scope_part_minimum = 0.1f;
  static constexpr float scope_part_maximum = 0.9f;

  Theme theme = Theme::dark;
  float column_width = 330.0f;  ///< width of the pane column, in points before scaling
  float scope_part = 0.42f;     ///< scope height divided by the shared height of scene and scope
  bool scope_is_shown = true;
  ScopeSettings scope;
  std::filesystem::path parameters_file;  ///< last file that was loaded or saved
  bool operator==(const WindowSettings&) const = default;
};

/// Returns $XDG_CONFIG_HOME/inkwell/window.toml or ~/.config/inkwell/window.toml; empty if neither directory is known.
std::filesystem::path window_settings_path();

struct LoadedSettings {
  WindowSettings settings;
  std::string problem;  ///< names the first line that is not TOML; empty: none
};

/// Returns the defaults if the file does not exist. Lines that are not TOML are ignored.
LoadedSettings read_settings(const std::filesystem::path& file);
/// Writes the settings that differ from `before`, which are the settings that were read. The other content of the file
/// remains: changes of another window, and settings, layouts and signals that this version does not know. If the file
/// has lines that are not TOML, damaged_copy() receives the old content. Returns an error message; empty on success.
std::string write_settings(const WindowSettings& settings, const std::filesystem::path& file,
                           const WindowSettings& before);
std::filesystem::path damaged_copy(const std::filesystem::path& file);

std::string format_settings(const WindowSettings& settings);
/// Uses the default for each unreadable or invalid setting, so that the window opens despite a damaged file.
WindowSettings parse_settings(const std::string& text);

}  // namespace inkwell::window
