#include "host/lab/soak/run.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/lab/soak/bench.hpp"

namespace inkwell::soak {
namespace {

/// Longer than any sitting. With this time limit, a locked-up processor does not stop board time.
constexpr double board_lives_s = 1e6;

class Run {
 public:
  Run(unsigned number, const Choices& choices, const device::VirtualBoardOptions& board,
      const std::function<void(const std::string&)>& print, const std::function<bool()>& is_stopped)
      : bench_(number, choices, board), print_(print), is_stopped_(is_stopped) {
    bench_.is_over = [this] { return is_over(); };
  }

  Sitting all() {
    std::vector<Kind> deck;
    bool goes_on = true;
    while (goes_on && !is_over()) {
      if (deck.empty()) deck = shuffled_deck(bench_.random);
      goes_on = phase(deck.back());
      deck.pop_back();
    }
    return take_together();
  }

 private:
  bool is_over() const {
    return bench_.oracle.board_time_s() >= bench_.choices.sitting_s || (is_stopped_ && is_stopped_());
  }

  /// Returns false if the board is unusable or the sitting is over.
  bool phase(Kind kind) {
    PhaseResult result{.number = static_cast<unsigned>(bench_.sitting.phases.size() + 1),
                       .kind = kind,
                       .begin_s = bench_.oracle.board_time_s()};
    bench_.oracle.begin(result.number, kind);
    bool goes_on = true;
    try {
      goes_on = play_or_restart(kind, result);
    } catch (const SittingOver&) {
      if (result.what.empty()) result.what = "cut off: the sitting is over";
      goes_on = false;
    }
    result.duration_s = bench_.oracle.board_time_s() - result.begin_s;
    bench_.sitting.phases.push_back(result);
    if (print_) print_(line_of(bench_.sitting, result) + new_findings());
    return goes_on;
  }

  bool play_or_restart(Kind kind, PhaseResult& result) {
    try {
      result.what = play(bench_, kind);
      bench_.check_all();
      return true;
    } catch (const PhaseFailed& failure) {
      return restart();
    } catch (const device::Error& error) {
      bench_.oracle.complain(Complaint::no_answer, error.what());
      return restart();
    }
  }

  /// Restarts the board after a failed phase, so that the failure does not affect the next phase.
  bool restart() {
    try {
      bench_.device_may_go = false;
      bench_.board.control().heal_all();
      bench_.board.control().usb(true);
      bench_.check_closely();
    } catch (const device::Error&) {  // already recorded
    }
    try {
      bench_.disturb(Disturbance::none);
      bench_.reset();
      bench_.make_active();
      return true;
    } catch (const device::Error& error) {
      bench_.oracle.complain(Complaint::no_way_back, fmt::format("after a failed phase: {}", error.what()));
      return false;
    }
  }

  std::string new_findings() {
    std::string text;
    const auto& findings = bench_.oracle.findings();
    for (; printed_ < findings.size(); ++printed_)
      text += fmt::format("    {} at {:.3f} s: {}\n", name_of(findings[printed_].complaint),
                          findings[printed_].board_time_s, findings[printed_].text);
    return text;
  }

  Sitting take_together() {
    Sitting sitting = bench_.sitting;
    const Oracle& oracle = bench_.oracle;
    sitting.board_time_s = oracle.board_time_s();
    sitting.findings = oracle.findings();
    sitting.faults_told = oracle.faults_reported();
    sitting.restarts = oracle.restarts();
    sitting.peak_motor_force_N = oracle.peak_motor_force_N();
    sitting.hardest_press = oracle.hardest_press();
    sitting.hardest_press_with_fault_over_ms = oracle.hardest_press_with_fault_over_ms();
    sitting.hardest_press_with_fault = oracle.hardest_press_with_fault();
    sitting.longest_interrupt_part = oracle.longest_interrupt_part();
    sitting.poses = oracle.poses();
    sitting.lost.poses = oracle.poses_lost();
    sitting.lost.poses_kept_back = oracle.poses_kept_back();
    return sitting;
  }

  Bench bench_;
  const std::function<void(const std::string&)>& print_;
  const std::function<bool()>& is_stopped_;
  std::size_t printed_ = 0;
};

}  // namespace

Sitting run_sitting(unsigned number, const Choices& choices, device::VirtualBoardOptions board,
                    const std::function<void(const std::string&)>& print, const std::function<bool()>& is_stopped) {
  board.real_time = false;
  board.paused = true;
  board.seconds = board_lives_s;
  board.brown_out_level = 3;  // setting of a flashed board
  board.seed = choices.seed + number;
  return Run(number, choices, board, print, is_stopped).all();
}

unsigned sittings_in(double board_time_s, const Choices& choices) {
  constexpr double rounding = 1e-9;  // tolerance for a sitting length computed as a fraction of the board time
  return static_cast<unsigned>(std::max(1.0, std::ceil(board_time_s / choices.sitting_s - rounding)));
}

}  // namespace inkwell::soak
