// Progress on standard error, so that what --json writes on standard output stays clean.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace inkwell::command_line {

/// A bar on a terminal. Elsewhere a line for each new step, a step being what stands before the first colon.
class ProgressBar {
 public:
  /// `done` from 0 to 1; without it there is no bar, because nobody knows when it ends.
  void operator()(std::string_view step, std::optional<double> done);
  /// Leaves the bar as it is and goes on below it.
  void end();

 private:
  std::string last_step_;
  bool is_open_ = false;
};

}  // namespace inkwell::command_line
