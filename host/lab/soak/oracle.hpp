// Compares the behavior of a board with the expected behavior. Records all contradictions.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/wide_reports.hpp"
#include "host/lab/soak/plan.hpp"
#include "protocol/reports.hpp"
#include "protocol/supervision.hpp"

namespace inkwell::soak {

// clang-format off
/// X(name, meaning)
#define INKWELL_SOAK_COMPLAINTS(X) \
  X(false_trip, "The board reported a fault without a cause.") \
  X(missed_fault, "The board did not report a fault although its cause was present.") \
  X(unasked_force, "The force switched on without a request.") \
  X(lost_force, "The force switched off without a request and without a reported fault.") \
  X(too_much_force, \
    "The motor force exceeded the force limit by more than 5 % in a control period, or, with an injected " \
    "fault, in the mean over a millisecond.") \
  X(restart, "The chip restarted without a cause.") \
  X(broken_rule, "The firmware violated a rule of the chip.") \
  X(wrong_parameters, "The board's parameters differ from the parameters that it accepted last.") \
  X(wrong_answer, \
    "An illegal transaction was accepted, a legal transaction was refused, or the reason for a refusal was wrong.") \
  X(wrong_pose, "The reported position of the probe differs from its true position.") \
  X(lost_packets, "Poses, scope samples within the bus capacity, program forces or parts of a recording were lost.") \
  X(no_answer, "The board did not answer, or did not execute a command.") \
  X(no_way_back, "After a fault was removed, the user could not restore the force, or needed a reset.")
// clang-format on

enum class Complaint : std::uint8_t {
#define X(name, ...) name,
  INKWELL_SOAK_COMPLAINTS(X)
#undef X
};
std::string_view name_of(Complaint complaint);

struct Finding {
  unsigned phase = 0;  ///< from 1
  Kind kind{};         ///< of the phase
  double board_time_s = 0;
  Complaint complaint{};
  std::string text;
};

/// Largest ratio of motor force to force limit.
struct Press {
  double force_N = 0, limit_N = 0;
  unsigned phase = 0;  ///< from 1
  Kind kind{};         ///< of the phase
  double board_time_s = 0;

  double part_of_limit() const { return limit_N > 0 ? force_N / limit_N : 0.0; }
};

/// State of a simulation at an instant.
struct Snapshot {
  double board_time_s = 0;
  double driven_until_s = 0;  ///< last time at which a leg was driven high
  unsigned restarts = 0;      ///< since the simulation's start
  /// Peak motor forces at the probe since the last snapshot, averaged over a control period and over a millisecond.
  /// Periods without a driven bridge are ignored.
  double peak_motor_force_N = 0, peak_motor_force_over_ms_N = 0;
};

/// Active disturbance.
enum class Disturbance : std::uint8_t {
  none,
  hardware,  ///< restarts and driven bridges are not judged; forces are judged only as means over a millisecond
  program,   ///< forces and firmware reports are not judged either, because the program is corrupted
};

class Oracle {
 public:
  static constexpr double force_tolerance = 1.05;
  /// With a lower force limit, the largest force is not recorded, because the current sensors are noisy.
  static constexpr double judged_limit_N = 0.5;

  void begin(unsigned phase, Kind kind);
  /// Every later fault report in this phase is an error.
  void allow_no_fault() { allowed_faults_ = {}; }
  /// Reports of lost counts are allowed until the next reference.
  void allow_lost_counts() { allowed_faults_ = lost_counts; }
  void disturb(Disturbance disturbance) { disturbance_ = disturbance; }

  void request_force();
  /// The force may stay on for `grace_s`.
  void withdraw_force(double grace_s);
  void limit_force(double force_limit_N) { force_limit_N_ = force_limit_N; }
  void expect_restart() { restart_expected_ = true; }
  /// Call this before the first pose of a connection.
  void connected() { sequence_.reset(); }

  void see(const device::Pose& pose);
  void see(const Snapshot& snapshot);
  /// Checks the number of restarts and the number of violated rules since the board's start. Returns true if the chip
  /// restarted since the last call.
  bool see_counts(unsigned restarts, unsigned long broken_rules, const std::string& newest_rule);
  /// Records a complaint if none of these faults was reported.
  void require_report_of(protocol::Conditions faults);
  void complain(Complaint complaint, std::string text);

  bool has_reported() const { return !reported_.empty(); }
  std::optional<protocol::Fault> last_reported() const {
    return reported_.empty() ? std::nullopt : std::optional(reported_.back());
  }
  bool force_is_requested() const { return force_is_requested_; }
  double force_limit_N() const { return force_limit_N_; }
  double board_time_s() const { return now_s_; }

  const std::vector<Finding>& findings() const { return findings_; }
  /// Peak motor force without a disturbance.
  double peak_motor_force_N() const { return peak_motor_force_N_; }
  /// Largest forces relative to the force limit. The functions with `_with_fault` return forces during a disturbance.
  /// The function with `_over_ms` returns means over a millisecond.
  const Press& hardest_press() const { return hardest_press_; }
  const Press& hardest_press_with_fault() const { return hardest_press_with_fault_; }
  const Press& hardest_press_with_fault_over_ms() const { return hardest_press_with_fault_over_ms_; }
  /// Longest control interrupt as a fraction of the control period.
  double longest_interrupt_part() const { return longest_interrupt_part_; }
  unsigned long poses() const { return poses_; }
  /// Number of missing poses without a disturbance.
  unsigned long poses_lost() const { return poses_lost_; }
  /// Number of missing poses during a disturbance.
  unsigned long poses_kept_back() const { return poses_kept_back_; }
  unsigned restarts() const { return restarts_; }
  const std::map<protocol::Fault, unsigned>& faults_reported() const { return faults_reported_; }

 private:
  void note_report(protocol::Fault fault);
  void miss(std::uint32_t poses);
  void take_back_permission(double grace_s);
  void follow_self_test(bool may_test_itself);
  void note(Press& hardest, double force_N) const;
  void judge_force(const Snapshot& snapshot);

  unsigned phase_ = 0;
  Kind kind_ = Kind::docking;
  protocol::Conditions allowed_faults_;
  Disturbance disturbance_ = Disturbance::none;
  std::vector<protocol::Fault> reported_;  ///< in this phase
  double now_s_ = 0;
  bool force_is_requested_ = false;
  double may_drive_until_s_ = 0;  ///< without a request
  bool may_test_itself_ = true;   ///< true during the self-test, from the start until the board reports its end
  bool test_is_over_ = false;     ///< the self-test ended since the last look
  unsigned restarts_checked_ = 0;
  double force_limit_N_ = 0;
  bool restart_expected_ = false;
  std::optional<std::int64_t> sequence_;
  protocol::State state_ = protocol::State::starting;
  bool force_may_be_on_ = false;  ///< in the newest pose before the last look, or in a later one
  protocol::Fault fault_ = protocol::Fault::none;
  unsigned restarts_ = 0;
  unsigned long rules_ = 0;

  std::vector<Finding> findings_;
  double peak_motor_force_N_ = 0, longest_interrupt_part_ = 0;
  Press hardest_press_, hardest_press_with_fault_, hardest_press_with_fault_over_ms_;
  unsigned long poses_ = 0, poses_lost_ = 0, poses_kept_back_ = 0;
  std::map<protocol::Fault, unsigned> faults_reported_;
};

}  // namespace inkwell::soak
