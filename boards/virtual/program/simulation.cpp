#include "boards/virtual/program/simulation.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "boards/virtual/program/commands.hpp"
#include "boards/virtual/program/log.hpp"

namespace inkwell::virtual_board {
namespace {

using namespace std::chrono_literals;

constexpr Ticks slice = ticks_per_s / 1000;  // about one USB bus frame
constexpr auto attention = 50ms;             // time for a paused board to notice a signal
constexpr auto poll_interval = 100us;        // polling interval for the other boards of a shared clock
constexpr double debt_maximum_s = 0.1;
constexpr int exit_code_of_lock_up = 3;
constexpr int exit_code_of_violation = 4;

}  // namespace

Simulation::Simulation(const Options& options, Board& board, ControlServer& server, StreamServer* gdb_server,
                       UartLinks& uarts)
    : options_(options),
      board_(board),
      server_(server),
      gdb_server_(gdb_server),
      uarts_(uarts),
      gdb_(board.chip()),
      passing_(options.paused ? Passing::not_at_all : Passing::freely) {
  if (!options.clock.empty()) clock_.emplace(options.clock);
  board_.usb().on_late_host([this] {
    answer_within_frame();
    return !quit_;
  });
  start_pacing();
}

int Simulation::run(const std::atomic<bool>& end_requested) {
  const Ticks end = options_.seconds ? ticks(*options_.seconds) : std::numeric_limits<Ticks>::max();
  while (!quit_ && !end_requested && !firmware_exit_code_ && !ends_by_violation() && board_.chip().now() < end) {
    if (gdb_server_ != nullptr) serve_debugger();
    uarts_.serve();
    const auto deadline = !time_passes()       ? Clock::now() + attention
                          : waits_for_others() ? Clock::now() + poll_interval
                                               : Clock::time_point::min();
    if (auto request = server_.take(deadline)) {
      serve(std::move(*request));
      continue;
    }
    board_.usb().serve();
    if (time_passes() && !waits_for_others()) advance();
  }
  uarts_.serve();  // sends the last bytes
  if (ends_by_violation()) {
    end_run(fmt::format("the firmware broke a rule of the chip: {}", sentence(board_.chip().violations().front())));
    list_violations();
    return exit_code_of_violation;
  }
  end_run("the virtual board exits");
  list_violations();
  if (firmware_exit_code_) return *firmware_exit_code_;
  return options_.seconds && board_.locked_up() ? exit_code_of_lock_up : 0;
}

bool Simulation::ends_by_violation() const { return options_.strict && !board_.chip().violations().empty(); }

void Simulation::list_violations() const {
  const auto& violations = board_.chip().violations();
  if (violations.empty()) return;
  log_line(fmt::format("rules of the chip that the firmware broke: {}", violations.size()));
  for (const Violation& violation : violations)
    log_line(violation.first, fmt::format("{} times: {} {}", violation.count, sentence(violation),
                                          board_.name_of_code(violation.code_address)));
}

bool Simulation::time_passes() const {
  if (gdb_.attached()) return !gdb_.halted();
  if (run_) return true;
  switch (passing_) {
    case Passing::freely: return !options_.lock_step || board_.usb().lets_time_pass();
    case Passing::during_control_transfers: return board_.usb().has_control_transfer();
    case Passing::not_at_all: break;
  }
  return false;
}

bool Simulation::waits_for_others() {
  if (!clock_) return false;
  clock_->note(board_.chip().now() / slice);
  return !clock_->lets_pass();
}

void Simulation::serve_debugger() {
  const auto arrived = gdb_server_->take();
  if (arrived.connected) {
    gdb_.attach();
    log_line(board_.chip().now(), "GDB has connected: board time is stopped");
  }
  gdb_server_->send(gdb_.receive(arrived.bytes));
  if (arrived.gone && gdb_.attached()) gdb_.detach();
}

void Simulation::serve(ControlRequest request) {
  board_.usb().settle();
  nlohmann::json reply = carry_out(request.line, *this);
  if (requested_run_s_) {
    run_ = Run{board_.chip().now() + ticks(*std::exchange(requested_run_s_, std::nullopt)), std::move(request.reply)};
    if (passing_ == Passing::freely) passing_ = Passing::not_at_all;
    start_pacing();
    return;
  }
  request.reply.set_value(std::move(reply));
}

/// Executes the pending commands in the middle of a USB frame.
void Simulation::answer_within_frame() {
  while (auto request = server_.take(Clock::time_point::min()))
    request->reply.set_value(carry_out_within_frame(request->line, *this));
}

void Simulation::advance() {
  Ticks target = (board_.chip().now() / slice + 1) * slice;
  if (run_) target = std::min(target, run_->end);
  if (options_.seconds) target = std::min(target, ticks(*options_.seconds));
  const Stop stop = board_.run_until(target);
  if (gdb_server_ != nullptr) gdb_server_->send(gdb_.report(stop));
  switch (stop) {
    case Stop::time_reached:
    case Stop::requested:
    case Stop::debugger: break;
    case Stop::locked_up:
      // With --seconds, board time continues after a lock-up, because a watchdog may reset the board.
      if (options_.seconds) break;
      end_run("the processor locked up: " + board_.chip().lockup_reason());
      return pause();
    case Stop::firmware_exit:
      firmware_exit_code_ = board_.chip().exit_code();
      log_line(board_.chip().now(), fmt::format("the firmware exited with code {}", *firmware_exit_code_));
      end_run("the firmware exited");
      return;
  }
  if (run_ && board_.chip().now() >= run_->end) {
    board_.usb().settle();
    run_->reply.set_value({{"ok", true}, {"board_time_s", seconds(board_.chip().now())}});
    run_.reset();
    return;
  }
  if (options_.real_time && (run_ || passing_ == Passing::freely)) pace();
}

void Simulation::start_pacing() {
  pace_wall_ = Clock::now();
  pace_board_ = board_.chip().now();
}

// Sleeps while board time is ahead of real time. A large lag of board time is dropped, because a user must not see the
// arm in fast motion.
void Simulation::pace() {
  const double board_s = seconds(board_.chip().now() - pace_board_);
  const double wall_s = std::chrono::duration<double>(Clock::now() - pace_wall_).count();
  if (wall_s - board_s > debt_maximum_s) {
    time_dropped_s_ += wall_s - board_s;
    start_pacing();
    return;
  }
  const auto due = pace_wall_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(board_s));
  while (Clock::now() < due && !quit_)
    if (auto request = server_.take(due)) serve(std::move(*request));
}

void Simulation::pause() {
  passing_ = Passing::not_at_all;
  end_run(fmt::format("the run was paused at {:.6f} s of board time", seconds(board_.chip().now())));
}

void Simulation::stand_by() {
  pause();
  passing_ = Passing::during_control_transfers;
}

void Simulation::resume() {
  passing_ = Passing::freely;
  start_pacing();
}

void Simulation::run_for(double duration_s) { requested_run_s_ = duration_s; }

void Simulation::end_run(const std::string& error) {
  if (!run_) return;
  run_->reply.set_value({{"ok", false}, {"error", error}});
  run_.reset();
}

}  // namespace inkwell::virtual_board
