// Locations of installed files for programs at run time. A build folder has links at the same relative paths
// (tools/cmake/installed_paths.cmake).
#pragma once

#include <filesystem>
#include <string>

namespace inkwell::installation {

/// The installation prefix, such as /usr, or the build folder. The search starts at the program or library and stops at
/// the nearest parent folder with arm descriptions. If no parent folder has arm descriptions, returns the program's
/// folder.
std::filesystem::path prefix();

/// Paths below the prefix; the caller checks whether they exist.
std::filesystem::path virtual_board();  ///< the program
/// ELF file of a firmware image.
std::filesystem::path firmware(const std::string& image = "inkwell.elf");
std::filesystem::path default_arm();    ///< the description of the Omni
std::filesystem::path dropins();        ///< folder of the drop-in libraries
std::filesystem::path import_helper();  ///< the program that reads objects with libraries

}  // namespace inkwell::installation
