// Runs third-party programs such as gnuplot without a shell.
#pragma once

// All child programs must be started with run_child_program(). A child program that reads a script must run in a folder
// from make_private_folder(). Texts for gnuplot must be quoted with recording::gnuplot_text().

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/error.hpp"
#include "host/client/local/private_folder.hpp"

namespace inkwell::device {

/// Creates a new, empty folder. Throws Error on failure.
local::PrivateFolder make_private_folder();

struct ChildProgram {
  std::vector<std::string> words;  ///< the program name, which is searched on PATH, and the arguments
  std::filesystem::path folder;    ///< working directory
  std::string advice;              ///< sentence for the user if the program cannot be started
};

/// Runs the program with an empty standard input until it exits. Passes pieces of standard output and standard error to
/// `on_output`. Returns the exit code, or 128 plus the number of the fatal signal. Throws Error if the program cannot
/// be started.
int run_child_program(const ChildProgram& program, const std::function<void(std::string_view)>& on_output);

}  // namespace inkwell::device
