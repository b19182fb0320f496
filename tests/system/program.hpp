// Runs programs: one of the built ones to its end, or one that is talked to while it runs.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <temporary_directory.hpp>

namespace inkwell::tests {

/// How long a whole program, and one answer of it, may take: they end what hangs and are no measure of speed, so a
/// machine that does thirty other things is still quick enough.
inline constexpr std::chrono::seconds hang_guard{1200}, patience{300};

struct ProgramResult {
  int exit_code;  ///< -1 if the program was ended by a signal or by the time limit
  std::string out;
  std::string err;
};

/// Runs build/pc/`program`, or the program of an absolute path, with the arguments. Ends it after `limit`, which no
/// healthy run reaches.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          std::chrono::seconds limit = hang_guard);

/// A program that runs until this object ends it. Its standard error goes where the test's goes.
class RunningProgram {
 public:
  /// `words`: the program, by name or by path, and its arguments. `environment`: "NAME=VALUE", added to the test's.
  RunningProgram(const std::vector<std::string>& words, const std::vector<std::string>& environment = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void write_line(const std::string& line);
  /// The next line of standard output; throws std::runtime_error if none comes within `limit`.
  std::string read_line(std::chrono::seconds limit = patience);
  /// Waits for its end; the exit code, or none if it was ended by a signal or still runs after `limit`.
  std::optional<int> wait(std::chrono::seconds limit = patience);
  int process() const { return process_; }

 private:
  std::string name_;
  int process_ = -1;
  int input_ = -1;
  int output_ = -1;
  std::string received_;
};

/// The directory of this executable: build/pc.
std::string build_directory();

}  // namespace inkwell::tests
