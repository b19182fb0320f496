// Runs a built program to its end, or interacts with a running program.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "tests/temporary_directory.hpp"

namespace inkwell::tests {

/// Time limits for a whole program and for one answer. The limits are long enough for a heavily loaded machine and stop
/// programs that hang.
inline constexpr std::chrono::seconds hang_guard{1200}, patience{300};

struct ProgramResult {
  int exit_code;  ///< -1 if a signal or the time limit stopped the program
  std::string out;
  std::string err;
};

/// Runs build/pc/`program`, or the program with an absolute path. Stops a hanging program after `limit`.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          std::chrono::seconds limit = hang_guard);

/// Runs a program during the lifetime of this object. The program shares the standard error of the test.
class RunningProgram {
 public:
  /// `words`: name or path of the program, and its arguments. `environment`: "NAME=VALUE", added to the environment of
  /// the test.
  RunningProgram(const std::vector<std::string>& words, const std::vector<std::string>& environment = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void write_line(const std::string& line);
  /// Returns the next line of standard output; throws std::runtime_error after `limit`.
  std::string read_line(std::chrono::seconds limit = patience);
  /// Waits for the exit code. Returns nothing if a signal stopped the program or if it still runs after `limit`.
  std::optional<int> wait(std::chrono::seconds limit = patience);
  int process() const { return process_; }

 private:
  std::string name_;
  int process_ = -1;
  int input_ = -1;
  int output_ = -1;
  std::string received_;
};

/// Directory of this executable: build/pc.
std::string build_directory();

}  // namespace inkwell::tests
