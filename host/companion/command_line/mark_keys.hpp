// Reads marks from standard input during a recording.
#pragma once

#include <optional>
#include <string>

#include <termios.h>

namespace inkwell::command_line {

/// On a terminal, each press of the space bar or the return key sets a numbered mark. On a pipe, each line is the text
/// of a mark.
class MarkKeys {
 public:
  explicit MarkKeys(int descriptor);
  /// Restores the terminal settings.
  ~MarkKeys();
  MarkKeys(const MarkKeys&) = delete;
  MarkKeys& operator=(const MarkKeys&) = delete;

  /// Returns the text of the next mark; empty if there is no mark. Does not wait.
  std::optional<std::string> next();

 private:
  void read_what_is_there();

  int descriptor_;
  std::optional<termios> terminal_before_;
  std::string pending_;
  int count_ = 0;
  bool is_at_end_ = false;
};

}  // namespace inkwell::command_line
