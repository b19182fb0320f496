// Shows progress on standard error, because standard output may contain the --json output.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace inkwell::command_line {

/// On a terminal, draws a progress bar. In a pipe or a file, prints one line per step. The text before the first colon
/// identifies a step.
class ProgressBar {
 public:
  /// `done` is the progress from 0 to 1. Without `done`, no bar is drawn.
  void operator()(std::string_view step, std::optional<double> done);
  /// Leaves the bar on the screen and starts a new line.
  void end();

 private:
  std::string last_step_;
  bool is_open_ = false;
};

}  // namespace inkwell::command_line
