// Where the parts of Inkwell lie that its programs use at run time. A build's folder has links where an installation
// has the parts, so that there is one way to find them (tools/cmake/places.cmake).
#pragma once

#include <filesystem>
#include <string>

namespace inkwell::installation {

/// The nearest folder, upwards from that of the program or shared library that this code is part of, which has arm
/// descriptions where an installation has them: the prefix, /usr for example, or the folder of a build. The
/// program's own folder if there is none.
std::filesystem::path prefix();

/// Below the prefix; whether they are there is for the caller to see.
std::filesystem::path virtual_board();  ///< the program
/// The ELF of an image that is flashed; board::image_name() has those of other boards than the default.
std::filesystem::path firmware(const std::string& image = "inkwell.elf");
std::filesystem::path default_arm();  ///< the description of the Omni
std::filesystem::path dropins();      ///< the folder of the libraries under the names of others

}  // namespace inkwell::installation
