// Lets board time pass: free, paced to the clock on the wall, or as far as a client asks.
//
// It passes in slices of a millisecond. Between two slices, and only there, what programs of this computer ask
// for takes effect: transfers on USB and commands of the control socket. How long a slice takes makes no difference
// then: a program that waits for each answer before it asks again finds the same board each time. While board time
// waits for a program that has stopped, in the middle of a slice, commands that change nothing are answered all the
// same.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <debugger/gdb_session.hpp>
#include <program/control_server.hpp>
#include <program/shared_clock.hpp>
#include <program/stream_server.hpp>

#include "board.hpp"
#include "options.hpp"
#include "uart_links.hpp"

namespace inkwell::virtual_board {

class Simulation {
 public:
  /// `gdb_server` may be null.
  Simulation(const Options& options, Board& board, ControlServer& server, StreamServer* gdb_server, UartLinks& uarts);

  /// Runs until a client quits, `end_requested` is set, the time of --seconds is over or the firmware ends.
  /// Without --seconds a locked-up board stands still, for somebody to look at it or reset it.
  /// Returns the exit code.
  int run(const std::atomic<bool>& end_requested);

  // ---- for the commands ----
  Board& board() { return board_; }
  const Options& options() const { return options_; }
  bool paused() const { return passing_ != Passing::freely; }
  bool stands_by() const { return passing_ == Passing::when_asked; }
  /// Board time that pacing gave up because the computer was too slow for it.
  double time_dropped_s() const { return time_dropped_s_; }
  /// Board time stands still.
  void pause();
  /// Board time stands still, but passes, as fast as it can, while a USB control transfer is under way.
  void stand_by();
  void resume();
  void quit() { quit_ = true; }
  bool is_running_for() const { return run_.has_value(); }
  /// Runs for this long, then answers the request that is being carried out; board time stands still again, or stands
  /// by if it did before.
  void run_for(double duration_s);

 private:
  using Clock = std::chrono::steady_clock;
  enum class Passing : std::uint8_t { freely, when_asked, not_at_all };
  struct Run {
    Ticks end;
    std::promise<nlohmann::json> reply;
  };
  bool time_passes() const;
  /// Another board with the same clock is behind.
  bool waits_for_others();
  void serve_debugger();
  bool ends_by_violation() const;
  void list_violations() const;
  void serve(ControlRequest request);
  void answer_within_frame();
  void advance();
  void pace();
  void start_pacing();
  void end_run(const std::string& error);

  const Options& options_;
  Board& board_;
  ControlServer& server_;
  StreamServer* gdb_server_;
  UartLinks& uarts_;
  std::optional<SharedClock> clock_;
  GdbSession gdb_;
  Passing passing_;
  bool quit_ = false;
  std::optional<Run> run_;
  std::optional<double> run_asked_s_;
  std::optional<int> firmware_exit_code_;
  double time_dropped_s_ = 0.0;
  Clock::time_point pace_wall_{};
  Ticks pace_board_ = 0;
};

}  // namespace inkwell::virtual_board
