#include "firmware/self_test/pulse_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace inkwell::link {
namespace {

using control::PulseRound;
using Result = protocol::SelfTestResult;
using Found = PulseJudgement::Found;

/// Expected values of a motor.
struct Expected {
  float resistance_ohm;
  float back_emf_Vs_per_count;
  float dead_V;
  bool is_confirmed;
};

/// Resistance from the pulses of one current sign, negative if the current has the wrong sign. The magnitude is limited
/// to `shown_maximum_ohm`.
float resistance_ohm(const PulseRound::Motor& motor, float low_A, float high_A, float shown_maximum_ohm) {
  const float step_V = motor.high_V - motor.low_V;
  const float step_A = high_A - low_A;
  if (std::fabs(step_A) * shown_maximum_ohm > step_V) return step_V / step_A;
  return shown_maximum_ohm;
}

/// Returns the ratio of the larger value to the smaller value.
float apart(float a, float b) { return a > b ? a / b : b / a; }

float mean_back_emf_V(const PulseRound::Motor& motor, const Expected& expected) {
  return std::fabs(static_cast<float>(motor.moved_counts) * expected.back_emf_Vs_per_count / motor.levels_s);
}

/// Returns the failure, or `moved` for a moving arm.
Result failed_or_moved(const PulseRound::Motor& motor, const Expected& expected, Result failure) {
  const bool moves = expected.is_confirmed ? mean_back_emf_V(motor, expected) > PulseJudgement::moves_V
                                           : std::abs(motor.moved_counts) > PulseJudgement::rests_counts;
  return moves ? Result::moved : failure;
}

struct OfMotor {
  Found motor, bridge;
  float kept_ohm = 0.0f;
  float estimate_ohm = 0.0f;
};

/// Result for a motor whose resistance differs from the parameter.
Result judge_resistance(float forward_ohm, float backward_ohm, bool is_confirmed) {
  constexpr float least_ohm = PulseJudgement::unknown_minimum_ohm, most_ohm = PulseJudgement::unknown_maximum_ohm;
  if (forward_ohm < 0.0f && backward_ohm < 0.0f) return Result::wrong_sign;
  if (is_confirmed) return Result::failed;
  if (forward_ohm >= PulseJudgement::missing_ohm && backward_ohm >= PulseJudgement::missing_ohm) return Result::missing;
  const bool is_motor =
      std::min(forward_ohm, backward_ohm) > least_ohm && std::max(forward_ohm, backward_ohm) < most_ohm;
  return is_motor ? Result::unknown_motor : Result::failed;
}

OfMotor judge_motor(const PulseRound::Motor& motor, std::size_t own, const Expected& expected) {
  if (!motor.takes_part) return {{Result::no_part}, {Result::no_part}};
  const auto& current_A = motor.current_A;
  const float shown_ohm =
      std::max(PulseJudgement::resistance_shown_part * expected.resistance_ohm, PulseJudgement::missing_ohm);
  const float forward_ohm = resistance_ohm(motor, current_A[0][own], current_A[1][own], shown_ohm);
  const float backward_ohm = resistance_ohm(motor, -current_A[3][own], -current_A[2][own], shown_ohm);
  const bool forward_is_worse =
      apart(forward_ohm, expected.resistance_ohm) > apart(backward_ohm, expected.resistance_ohm);
  const float worse_ohm = forward_is_worse ? forward_ohm : backward_ohm;
  const float part = worse_ohm / expected.resistance_ohm;
  const float estimate_ohm = std::min(std::fabs(forward_ohm), std::fabs(backward_ohm));
  Found found{Result::passed, worse_ohm};
  if (!(part > PulseJudgement::resistance_minimum_part && part < PulseJudgement::resistance_maximum_part))
    found.result = judge_resistance(forward_ohm, backward_ohm, expected.is_confirmed);
  if (found.result != Result::passed) found.result = failed_or_moved(motor, expected, found.result);
  if (found.result != Result::passed) return {found, {}, 0.0f, estimate_ohm};
  // Voltage loss extrapolated to zero current. The mean over both current signs cancels the effect of a back EMF.
  const float bridge_V = motor.high_V - 0.5f * (forward_ohm * current_A[1][own] - backward_ohm * current_A[2][own]);
  const bool is_slow = bridge_V > PulseJudgement::dead_time_ratio * expected.dead_V;
  const bool is_kept = apart(forward_ohm, backward_ohm) < PulseJudgement::kept_apart &&
                       mean_back_emf_V(motor, expected) < PulseJudgement::rests_V;
  return {found,
          {is_slow ? failed_or_moved(motor, expected, Result::failed) : Result::passed, bridge_V},
          is_kept ? 0.5f * (forward_ohm + backward_ohm) : 0.0f,
          estimate_ohm};
}

/// Evaluates the currents in the sensors of the other motors. `resistance_ohm` is the resistance of the pulsed motor.
Found judge_wires(const PulseRound::Motor& motor, std::size_t own, const Expected& expected, float resistance_ohm) {
  if (!motor.takes_part) return {Result::no_part};
  float foreign_A = 0.0f;
  for (std::size_t i = 0; i < 3; ++i)
    if (i != own) foreign_A = std::max(foreign_A, 0.5f * std::fabs(motor.current_A[1][i] - motor.current_A[2][i]));
  const float own_A = (motor.high_V - expected.dead_V) / resistance_ohm;
  const bool is_insulated = foreign_A < PulseJudgement::foreign_part * own_A;
  return {is_insulated ? Result::passed : failed_or_moved(motor, expected, Result::failed), foreign_A};
}

/// Combines two results of one item. The order of precedence is failure, `moved`, larger figure.
Found worse(const Found& a, const Found& b) {
  const auto rank = [](Result result) {
    return protocol::is_failure(result) ? 3 : result == Result::moved ? 2 : result == Result::passed ? 1 : 0;
  };
  if (rank(a.result) != rank(b.result)) return rank(a.result) > rank(b.result) ? a : b;
  return a.figure > b.figure ? a : b;
}

}  // namespace

bool PulseJudgement::any(Result result) const {
  bool is_there = wires.result == result;
  for (std::size_t i = 0; i < 3; ++i) is_there |= motors[i].result == result || bridges[i].result == result;
  return is_there;
}

PulseJudgement PulseJudgement::moved() {
  PulseJudgement judgement{};
  judgement.motors.fill({Result::moved});
  judgement.bridges.fill({Result::moved});
  judgement.wires = {Result::moved};
  return judgement;
}

PulseJudgement judge(const control::PulseRound& round, const control::Settings& settings) {
  PulseJudgement judgement{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Expected expected{
        settings.motor_model.resistance_ohm[i],
        settings.motor_model.back_emf_Vs_per_rad[i] * settings.encoders.rad_per_count[i],
        round.dead_V,
        settings.motor_model.is_confirmed,
    };
    const OfMotor found = judge_motor(round.motors[i], i, expected);
    judgement.motors[i] = found.motor;
    judgement.bridges[i] = found.bridge;
    judgement.resistance_ohm[i] = found.kept_ohm;
    judgement.estimate_ohm[i] =
        std::clamp(found.estimate_ohm, PulseJudgement::smallest_ohm, PulseJudgement::largest_ohm);
    if (found.bridge.result == Result::passed)
      judgement.bridge_loss_part[i] = std::max(found.bridge.figure, 0.0f) / round.supply_V;
    const bool is_as_expected = !protocol::awaits_motor(found.motor.result);
    const Found wires =
        judge_wires(round.motors[i], i, expected, is_as_expected ? expected.resistance_ohm : judgement.estimate_ohm[i]);
    judgement.wires = i == 0 ? wires : worse(judgement.wires, wires);
  }
  return judgement;
}

}  // namespace inkwell::link
