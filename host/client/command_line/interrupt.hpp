// Handles Ctrl-C as a request to stop.
#pragma once

#include <csignal>

namespace inkwell::command_line {

/// While a guard exists, SIGINT and SIGTERM are recorded instead of terminating the program. A second signal terminates
/// the program.
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
