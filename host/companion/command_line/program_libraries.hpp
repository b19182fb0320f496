// Libraries that a program needs, and libraries that a process has loaded.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace inkwell::command_line {

/// Returns the names in the DT_NEEDED entries of an ELF file. Returns no names for scripts and unreadable files.
/// `program` is a path, or a name that is searched in PATH.
std::vector<std::string> needed_libraries(const std::string& program);

/// Returns a library of the HDAPI or of libhdPhantom that the process or one of its children has loaded. Prefers
/// a library outside of the folder `own`. Returns nothing if no such library is loaded.
std::optional<std::filesystem::path> loaded_device_library(pid_t process, const std::filesystem::path& own);

/// Returns true for a library of the vendor's drivers, which the drop-in libraries do not replace.
bool is_vendor_driver(std::string_view library);

}  // namespace inkwell::command_line
