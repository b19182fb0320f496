// Shows progress on standard error, so that the --json output on standard output stays valid.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace inkwell::command_line {

/// A bar on a terminal. Otherwise one line per new step; the text before the first colon identifies a step.
class ProgressBar {
 public:
  /// `done` from 0 to 1. Without it no bar is shown, because the duration is unknown.
  void operator()(std::string_view step, std::optional<double> done);
  /// Leaves the bar on the screen and starts a new line.
  void end();

 private:
  std::string last_step_;
  bool is_open_ = false;
};

}  // namespace inkwell::command_line
