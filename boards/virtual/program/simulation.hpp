// Starts, paces and stops board time.
//
// Board time passes in slices of one millisecond. Requests of local programs, such as USB transfers and control socket
// commands, take effect only between two slices. The wall-clock duration of a slice therefore has no effect. The
// results are reproducible if each program waits for each answer before its next request. A wait for a stopped program
// can interrupt a slice. During this wait, only commands that do not change the board are executed.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "boards/stm32f405/debugger/gdb_session.hpp"
#include "boards/virtual/program/control_server.hpp"
#include "boards/virtual/program/shared_clock.hpp"
#include "boards/virtual/program/stream_server.hpp"

#include "boards/virtual/program/board.hpp"
#include "boards/virtual/program/options.hpp"
#include "boards/virtual/program/uart_links.hpp"

namespace inkwell::virtual_board {

class Simulation {
 public:
  /// `gdb_server` may be null.
  Simulation(const Options& options, Board& board, ControlServer& server, StreamServer* gdb_server, UartLinks& uarts);

  /// Runs until a client quits, `end_requested` is set, the time of --seconds has passed or the firmware exits. Without
  /// --seconds, board time stops when the processor locks up, so that a user can inspect or reset the board. Returns
  /// the exit code.
  int run(const std::atomic<bool>& end_requested);

  // ---- interface for the commands ----
  Board& board() { return board_; }
  const Options& options() const { return options_; }
  bool paused() const { return passing_ != Passing::freely; }
  bool stands_by() const { return passing_ == Passing::during_control_transfers; }
  /// Returns the dropped lag of board time behind real time.
  double time_dropped_s() const { return time_dropped_s_; }
  void pause();
  /// Stops board time except during USB control transfers.
  void stand_by();
  void resume();
  void quit() { quit_ = true; }
  bool is_running_for() const { return run_.has_value(); }
  /// Runs for `duration_s`, then replies to the present request. Afterward board time is paused or in its previous
  /// standby.
  void run_for(double duration_s);

 private:
  using Clock = std::chrono::steady_clock;
  enum class Passing : std::uint8_t { freely, during_control_transfers, not_at_all };
  struct Run {
    Ticks end;
    std::promise<nlohmann::json> reply;
  };
  bool time_passes() const;
  /// Returns true if another board of the shared clock has not reached this board's time.
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
  std::optional<double> requested_run_s_;
  std::optional<int> firmware_exit_code_;
  double time_dropped_s_ = 0.0;
  Clock::time_point pace_wall_{};
  Ticks pace_board_ = 0;
};

}  // namespace inkwell::virtual_board
