// Judges what a board does by what was done to it. Pure: it is told both, and keeps what does not fit.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <device/wide_reports.hpp>
#include <protocol/reports.hpp>
#include <protocol/supervision.hpp>
#include <soak/plan.hpp>

namespace inkwell::soak {

// clang-format off
/// X(name, meaning)
#define INKWELL_SOAK_COMPLAINTS(X)                                                                             \
  X(false_trip, "A fault was told that nothing had caused.")                                                   \
  X(missed_fault, "A fault was not told although its cause was there.")                                        \
  X(unasked_force, "The force was on although nobody had asked for it since it was off.")                      \
  X(lost_force, "The force went off although nobody had asked for that and no fault was told.")                \
  X(too_much_force, "The motors pressed with more than the force limit and 5 % in a control period, or, with a fault put in, in the mean over a millisecond.") \
  X(restart, "The chip started anew although nothing had caused it.")                                          \
  X(broken_rule, "The firmware did what silicon would not bear.")                                              \
  X(wrong_parameters, "The parameters that the board holds are not those that it accepted last.")              \
  X(wrong_answer, "A transaction was accepted that is illegal, or refused that is legal, or for another reason.") \
  X(wrong_pose, "The board believes the probe to be elsewhere than it is.")                                    \
  X(lost_packets, "Poses, samples of a scope that the bus carries, forces of a program or parts of a recording were lost.") \
  X(no_answer, "The board did not answer, or did not do what it was asked for.")                               \
  X(no_way_back, "A fault was healed, but the user's way back did not lead to force, or only by a reset.")
// clang-format on

enum class Complaint : std::uint8_t {
#define X(name, ...) name,
  INKWELL_SOAK_COMPLAINTS(X)
#undef X
};
std::string_view name_of(Complaint complaint);

struct Finding {
  unsigned phase = 0;  ///< from 1 on
  std::string kind;    ///< of the phase
  double board_time_s = 0;
  std::string complaint;
  std::string text;
};

/// How hard the motors pressed, where that was the most of the force limit of its time.
struct Press {
  double force_N = 0, limit_N = 0;
  unsigned phase = 0;  ///< from 1 on
  std::string kind;    ///< of the phase
  double board_time_s = 0;

  double part_of_limit() const { return limit_N > 0 ? force_N / limit_N : 0.0; }
};

/// What a simulation tells at an instant.
struct Look {
  double board_time_s = 0;
  double driven_until_s = 0;  ///< the last time that a leg was at the supply
  unsigned restarts = 0;      ///< since the simulation's start
  /// That the torques of the motors put on the probe since the last look, while a bridge drove, in the mean over a
  /// control period and over a millisecond.
  double peak_motor_force_N = 0, peak_motor_force_over_ms_N = 0;
};

/// What was put in and not healed yet.
enum class Disturbance : std::uint8_t {
  none,
  hardware,  ///< restarts and whether the bridges drive are not judged, and forces over a millisecond only
  program,   ///< nor is any force, nor what the firmware says: it does not run as it was written
};

class Oracle {
 public:
  static constexpr double force_tolerance = 1.05;
  /// Of a lower force limit the noise of the current sensors is a large part, which tells nothing.
  static constexpr double telling_limit_N = 0.5;

  void begin(unsigned phase, Kind kind);
  /// The cause is gone: nothing may be told any more in this phase.
  void allow_no_fault() { may_tell_ = 0; }
  /// The cause is gone, but not what it did to a reference: counts that were lost may be noticed until there is
  /// another.
  void allow_lost_counts() { may_tell_ = lost_counts; }
  void disturb(Disturbance disturbance) { disturbance_ = disturbance; }

  /// Asked for from now on.
  void ask_for_force();
  /// Not any more; it may go on for so long.
  void give_up_force(double grace_s);
  /// From now on.
  void limit_force(double force_limit_N) { force_limit_N_ = force_limit_N; }
  /// The next restart is wanted.
  void expect_restart() { restart_expected_ = true; }
  /// Poses of a new connection begin.
  void connected() { sequence_.reset(); }

  void see(const device::Pose& pose);
  void see(const Look& look);
  /// Counts since the board's start. True if the chip started anew since the last call.
  bool see_counts(unsigned restarts, unsigned long broken_rules, const std::string& newest_rule);
  /// One of them.
  void must_have_told(protocol::Watches faults);
  void complain(Complaint complaint, std::string text);

  bool has_told() const { return !told_.empty(); }
  std::optional<protocol::Fault> told() const { return told_.empty() ? std::nullopt : std::optional(told_.back()); }
  bool force_is_asked_for() const { return asked_; }
  double force_limit_N() const { return force_limit_N_; }
  double board_time_s() const { return now_s_; }

  const std::vector<Finding>& findings() const { return findings_; }
  /// With the force on, while nothing was put in.
  double peak_motor_force_N() const { return peak_motor_force_N_; }
  /// With the force on and a limit of telling_limit_N or more: while nothing was put in; while something was, a program
  /// that is not the flashed one included; and then in the mean over a millisecond.
  const Press& hardest_press() const { return hardest_press_; }
  const Press& hardest_press_with_fault() const { return hardest_press_with_fault_; }
  const Press& hardest_press_with_fault_over_ms() const { return hardest_press_with_fault_over_ms_; }
  /// Of its period, while nothing was put in.
  double longest_interrupt_part() const { return longest_interrupt_part_; }
  unsigned long poses() const { return poses_; }
  /// Poses missing within connections, while nothing was put in: frames without one.
  unsigned long poses_lost() const { return poses_lost_; }
  /// The same while something was: a core that is halted makes none, a host that is silent asks for none.
  unsigned long poses_kept_back() const { return poses_kept_back_; }
  unsigned restarts() const { return restarts_; }
  const std::map<std::string, unsigned>& faults_told() const { return faults_told_; }

 private:
  void tell(protocol::Fault fault);
  void miss(std::uint32_t poses);
  void take_back_permission(double grace_s);
  void follow_self_test(bool may_test_itself);
  void note(Press& hardest, double force_N) const;
  void judge_force(const Look& look);

  unsigned phase_ = 0;
  Kind kind_ = Kind::docking;
  protocol::Watches may_tell_ = 0;
  Disturbance disturbance_ = Disturbance::none;
  std::vector<protocol::Fault> told_;  ///< in this phase
  double now_s_ = 0;
  bool asked_ = false;
  double may_drive_until_s_ = 0;  ///< without having been asked
  bool may_test_itself_ = true;   ///< it drives for its self-test, from its start until it tells that it is past that
  bool test_is_over_ = false;     ///< since the last look
  unsigned restarts_looked_at_ = 0;
  double force_limit_N_ = 0;
  bool restart_expected_ = false;
  std::optional<std::int64_t> sequence_;
  protocol::State state_ = protocol::State::starting;
  bool force_may_be_on_ = false;  ///< in the newest pose before the last look, or in one since
  protocol::Fault fault_ = protocol::Fault::none;
  unsigned restarts_ = 0;
  unsigned long rules_ = 0;

  std::vector<Finding> findings_;
  double peak_motor_force_N_ = 0, longest_interrupt_part_ = 0;
  Press hardest_press_, hardest_press_with_fault_, hardest_press_with_fault_over_ms_;
  unsigned long poses_ = 0, poses_lost_ = 0, poses_kept_back_ = 0;
  std::map<std::string, unsigned> faults_told_;
};

}  // namespace inkwell::soak
