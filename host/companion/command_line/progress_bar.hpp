// Shows progress on standard error, so that the --json output on standard output stays valid.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace inkwell::command_line {

/// Draws a bar on a terminal, and otherwise prints one line per new step. The text before the first colon identifies a
/// step.
class ProgressBar {
 public:
  /// `done` from 0 to 1. Without `done` no bar is shown, because the duration is unknown.
  void operator()(std::string_view step, std::optional<double> done);
  /// Leaves the bar on the screen and starts a new line.
  void end();

 private:
  std::string last_step_;
  bool is_open_ = false;
};

}  // namespace inkwell::command_line
