// Lets board time pass: free, paced to the wall clock, or as far as a client asks, and serves the control
// socket between slices of a millisecond.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

#include "board.hpp"
#include "control_server.hpp"
#include "options.hpp"

namespace inkwell::virtual_board {

class Simulation {
 public:
  Simulation(const Options& options, Board& board, ControlServer& server);

  /// Runs until a client quits, `end_requested` is set, the time of --seconds is over or the firmware ends.
  /// Returns the exit code.
  int run(const std::atomic<bool>& end_requested);

  // ---- for the commands ----
  Board& board() { return board_; }
  const Options& options() const { return options_; }
  bool paused() const { return paused_; }
  /// Board time that pacing gave up because the computer was too slow for it.
  double time_dropped_s() const { return time_dropped_s_; }
  void pause();
  void resume();
  void quit() { quit_ = true; }
  bool is_running_for() const { return run_.has_value(); }
  /// Runs for this long, then pauses and answers the request that is being carried out.
  void run_for(double duration_s);

 private:
  using Clock = std::chrono::steady_clock;
  struct Run {
    Ticks end;
    std::promise<nlohmann::json> reply;
  };
  void serve(ControlRequest request);
  void advance();
  void pace();
  void start_pacing();
  void end_run(const std::string& error);

  const Options& options_;
  Board& board_;
  ControlServer& server_;
  bool paused_;
  bool quit_ = false;
  std::optional<Run> run_;
  std::optional<double> run_asked_s_;
  std::optional<int> firmware_exit_code_;
  double time_dropped_s_ = 0.0;
  Clock::time_point pace_wall_{};
  Ticks pace_board_ = 0;
};

}  // namespace inkwell::virtual_board
