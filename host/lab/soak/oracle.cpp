#include "host/lab/soak/oracle.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace inkwell::soak {
namespace {

using protocol::Fault;
using protocol::State;

/// Poses and bridge states may be older than the latest action by this time.
constexpr double tolerated_delay_s = 0.01;

}  // namespace

std::string_view name_of(Complaint complaint) {
  constexpr std::string_view names[] = {
#define X(name, ...) #name,
      INKWELL_SOAK_COMPLAINTS(X)
#undef X
  };
  return names[static_cast<std::size_t>(complaint)];
}

void Oracle::begin(unsigned phase, Kind kind) {
  phase_ = phase;
  kind_ = kind;
  allowed_faults_ = info(kind).allowed_faults;
  reported_.clear();
}

void Oracle::request_force() { force_is_requested_ = true; }

void Oracle::withdraw_force(double grace_s) { take_back_permission(grace_s + tolerated_delay_s); }

void Oracle::take_back_permission(double grace_s) {
  if (!std::exchange(force_is_requested_, false)) return;
  may_drive_until_s_ = now_s_ + grace_s;
}

void Oracle::see(const device::Pose& pose) {
  ++poses_;
  if (sequence_) miss(pose.sequence - *sequence_ - 1);
  sequence_ = pose.sequence;

  if (disturbance_ == Disturbance::none)
    longest_interrupt_part_ = std::max(longest_interrupt_part_, pose.servo_load / 255.0);
  const State before = std::exchange(state_, pose.state);
  force_may_be_on_ |= protocol::force_is_on(state_);
  const Fault fault_before = std::exchange(fault_, pose.fault);
  if (pose.state == State::fault && (before != State::fault || fault_before != pose.fault)) {
    note_report(pose.fault);
    take_back_permission(tolerated_delay_s);
  }
  follow_self_test(pose.state == State::starting || pose.state == State::testing);
  if (disturbance_ == Disturbance::program) return;
  if (protocol::force_is_on(pose.state)) {
    if (!force_is_requested_ && now_s_ > may_drive_until_s_)
      complain(Complaint::unasked_force,
               fmt::format("the state is {} without a request", protocol::info(pose.state).name));
  } else if (protocol::force_is_on(before) && pose.state != State::fault && force_is_requested_ &&
             disturbance_ == Disturbance::none) {
    complain(Complaint::lost_force,
             fmt::format("from {} to {}", protocol::info(before).name, protocol::info(pose.state).name));
  }
}

void Oracle::miss(std::uint32_t poses) {
  if (poses == 0) return;
  if (disturbance_ != Disturbance::none) {
    poses_kept_back_ += poses;
    return;
  }
  poses_lost_ += poses;
  complain(Complaint::lost_packets, fmt::format("poses missing: {}", poses));
}

void Oracle::follow_self_test(bool may_test_itself) {
  test_is_over_ |= may_test_itself_ && !may_test_itself;
  may_test_itself_ = may_test_itself;
}

void Oracle::see(const Snapshot& snapshot) {
  now_s_ = snapshot.board_time_s;
  if (std::exchange(restarts_checked_, snapshot.restarts) != snapshot.restarts) follow_self_test(true);
  // The self-test's pulses are not subject to the force limit.
  const bool tested_itself = may_test_itself_ || test_is_over_;
  if (std::exchange(test_is_over_, false)) may_drive_until_s_ = std::max(may_drive_until_s_, now_s_);
  if (std::exchange(force_may_be_on_, protocol::force_is_on(state_)) && !tested_itself) judge_force(snapshot);
  if (disturbance_ != Disturbance::none) return;
  if (!force_is_requested_ && !may_test_itself_ && snapshot.driven_until_s > may_drive_until_s_ + tolerated_delay_s)
    complain(Complaint::unasked_force, fmt::format("a leg was driven high at {:.4f} s; this was allowed until {:.4f} s",
                                                   snapshot.driven_until_s, may_drive_until_s_));
}

void Oracle::note(Press& hardest, double force_N) const {
  if (force_limit_N_ < judged_limit_N || force_N / force_limit_N_ <= hardest.part_of_limit()) return;
  hardest = {force_N, force_limit_N_, phase_, kind_, now_s_};
}

void Oracle::judge_force(const Snapshot& snapshot) {
  const bool is_undisturbed = disturbance_ == Disturbance::none;
  note(is_undisturbed ? hardest_press_ : hardest_press_with_fault_, snapshot.peak_motor_force_N);
  if (is_undisturbed)
    peak_motor_force_N_ = std::max(peak_motor_force_N_, snapshot.peak_motor_force_N);
  else
    note(hardest_press_with_fault_over_ms_, snapshot.peak_motor_force_over_ms_N);
  if (disturbance_ == Disturbance::program) return;
  // A fault may increase the force for a few periods, until the bridges are off. This increase is too short to move the
  // arm.
  const double judged_N = is_undisturbed ? snapshot.peak_motor_force_N : snapshot.peak_motor_force_over_ms_N;
  // Force noise of the current sensors.
  constexpr double noise_N = 0.1;
  if (judged_N > force_tolerance * force_limit_N_ + noise_N)
    complain(Complaint::too_much_force, fmt::format("the motor force is {:.2f} N{}, the limit is {:.2f} N", judged_N,
                                                    is_undisturbed ? "" : " over a millisecond", force_limit_N_));
}

bool Oracle::see_counts(unsigned restarts, unsigned long broken_rules, const std::string& newest_rule) {
  if (broken_rules > rules_ && disturbance_ != Disturbance::program) complain(Complaint::broken_rule, newest_rule);
  rules_ = broken_rules;
  const bool restarted = restarts > restarts_;
  if (restarted) {
    const unsigned wanted = std::exchange(restart_expected_, false) ? 1 : 0;
    if (disturbance_ == Disturbance::none && restarts > restarts_ + wanted)
      complain(Complaint::restart, fmt::format("{} of them", restarts - restarts_ - wanted));
    state_ = State::starting;
    take_back_permission(tolerated_delay_s);
  }
  restarts_ = restarts;
  return restarted;
}

void Oracle::require_report_of(protocol::Conditions faults) {
  if (std::ranges::any_of(reported_, [&](Fault fault) { return (faults & protocol::condition(fault)).any(); })) return;
  std::vector<std::string_view> names;
  for (const protocol::Condition& row : protocol::condition_table)
    if ((faults & protocol::condition(row.fault)).any()) names.push_back(protocol::info(row.fault).name);
  complain(Complaint::missed_fault, fmt::format("{} was not reported", fmt::join(names, " or ")));
}

void Oracle::note_report(Fault fault) {
  reported_.push_back(fault);
  ++faults_reported_[fault];
  if (!(allowed_faults_ & protocol::condition(fault)).any())
    complain(Complaint::false_trip, fmt::format("{}", protocol::info(fault).name));
}

void Oracle::complain(Complaint complaint, std::string text) {
  // Only the first complaint of a kind is recorded in each phase.
  for (const Finding& finding : findings_)
    if (finding.phase == phase_ && finding.complaint == complaint) return;
  findings_.push_back({phase_, kind_, now_s_, complaint, std::move(text)});
}

}  // namespace inkwell::soak
