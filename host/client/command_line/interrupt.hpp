// Handles Ctrl-C as a request to stop.
#pragma once

#include <csignal>

namespace inkwell::command_line {

/// While an InterruptGuard exists, the first SIGINT or SIGTERM is only recorded. A second signal terminates the
/// program.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool is_interrupted() const;

 private:
  struct sigaction interrupt_before_, terminate_before_;
};

}  // namespace inkwell::command_line
