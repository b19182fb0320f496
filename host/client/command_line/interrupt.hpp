// Handles Ctrl-C, SIGTERM and a closed terminal as a request to stop.
#pragma once

#include "host/client/local/ending_signals.hpp"

namespace inkwell::command_line {

/// While an InterruptGuard exists, the first SIGINT, SIGTERM or SIGHUP is only recorded. A second signal of the
/// same kind terminates the program.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();

  bool is_interrupted() const;

 private:
  local::EndingSignalsHandler handler_;
};

}  // namespace inkwell::command_line
