// Ctrl-C as a wish that long work can grant in its own time.
#pragma once

#include <csignal>

namespace inkwell::command_line {

/// While it lives, SIGINT and SIGTERM are noted instead of ending the program. A second one ends it after all.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool was_asked_to_end() const;

 private:
  struct sigaction interrupt_before_, terminate_before_;
};

}  // namespace inkwell::command_line
