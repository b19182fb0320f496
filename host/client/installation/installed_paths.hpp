// Locations of installed files for programs at run time. A build folder has links at the same relative paths
// (tools/cmake/installed_paths.cmake), so the same code works in a build folder and in an installation.
#pragma once

#include <filesystem>
#include <string>

namespace inkwell::installation {

/// The installation prefix, such as /usr, or the build folder. The search goes upward from the program or shared
/// library that contains this code, to the nearest folder with arm descriptions at the installed path. Without such a
/// folder, the result is the program's folder.
std::filesystem::path prefix();

/// Paths below the prefix; the caller checks whether they exist.
std::filesystem::path virtual_board();  ///< the program
/// ELF file of a firmware image; board::image_name() returns the names for other boards.
std::filesystem::path firmware(const std::string& image = "inkwell.elf");
std::filesystem::path default_arm();  ///< the description of the Omni
std::filesystem::path dropins();      ///< folder of the drop-in libraries

}  // namespace inkwell::installation
