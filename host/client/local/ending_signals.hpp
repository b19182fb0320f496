// The signals that ask a program to exit: Ctrl-C, a terminating system, and a closed terminal.
#pragma once

#include <array>
#include <csignal>

namespace inkwell::local {

inline constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP};

/// Returns true if the starter of the program asked it to survive a closed terminal, as `nohup` does.
inline bool is_ignored_hang_up(int signal) {
  struct sigaction action {};
  return signal == SIGHUP && sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// Handles the ending signals during its lifetime.
class EndingSignalsHandler {
 public:
  /// An interrupted system call is repeated, so that no output is lost. `more_flags`: additional flags of sigaction().
  explicit EndingSignalsHandler(void (*handler)(int), int more_flags = 0) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART | more_flags;
    for (std::size_t i = 0; i < ending_signals.size(); ++i)
      sigaction(ending_signals[i], is_ignored_hang_up(ending_signals[i]) ? nullptr : &action, &before_[i]);
  }
  ~EndingSignalsHandler() {
    for (std::size_t i = 0; i < ending_signals.size(); ++i) sigaction(ending_signals[i], &before_[i], nullptr);
  }
  EndingSignalsHandler(const EndingSignalsHandler&) = delete;
  EndingSignalsHandler& operator=(const EndingSignalsHandler&) = delete;

 private:
  std::array<struct sigaction, ending_signals.size()> before_{};
};

}  // namespace inkwell::local
