// Other people's programs that this one runs and waits for, such as gnuplot and openocd. No shell reads their
// arguments.
#pragma once

// Start every child program with run_child_program(). If the program reads a script, run it in a folder from
// make_private_folder(). Quote texts for gnuplot with recording::gnuplot_text().

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <device/error.hpp>
#include <local/private_folder.hpp>

namespace inkwell::device {

/// A new, empty folder for files. Throws Error if the system refuses it.
local::PrivateFolder make_private_folder();

struct ChildProgram {
  std::vector<std::string> words;  ///< its name, which is looked for on PATH, and its arguments
  std::filesystem::path folder;    ///< in which it runs
  std::string advice;              ///< sentence for a user whose computer cannot start it
};

/// Runs the program to its end, with nothing on its standard input. `on_output` gets what it prints on standard output
/// and standard error, in pieces. Returns its exit code, or 128 and the signal that ended it. Throws Error if it cannot
/// be started.
int run_child_program(const ChildProgram& program, const std::function<void(std::string_view)>& on_output);

}  // namespace inkwell::device
