// Folder of the user's settings.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace inkwell::local {

/// Returns $XDG_CONFIG_HOME/inkwell or ~/.config/inkwell; empty if neither folder is known.
inline std::filesystem::path configuration_folder() {
  if (const char* configuration = std::getenv("XDG_CONFIG_HOME"); configuration != nullptr && *configuration == '/')
    return std::filesystem::path(configuration) / "inkwell";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::filesystem::path(home) / ".config" / "inkwell";
  return {};
}

}  // namespace inkwell::local
