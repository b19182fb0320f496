// Runs one of the built programs and keeps what it said.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <temporary_directory.hpp>

namespace inkwell::tests {

struct ProgramResult {
  int exit_code;  ///< -1 if the program was ended by a signal or by the time limit
  std::string out;
  std::string err;
};

/// Runs build/pc/`program`, or the program of an absolute path, with the arguments. Ends it after `limit`, which no healthy run reaches.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          std::chrono::seconds limit = std::chrono::seconds(120));

/// The directory of this executable: build/pc.
std::string build_directory();

}  // namespace inkwell::tests
