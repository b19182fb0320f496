#include "firmware/control/settings.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/control/signal_path/conditioning.hpp"
#include "firmware/control/supervision/brake.hpp"
#include "firmware/control/supervision/self_test_pulses.hpp"
#include "firmware/control/supervision/stuck_encoder.hpp"
#include "protocol/faults.hpp"

namespace inkwell::control {

namespace {

using protocol::Parameter;
using protocol::ParameterSet;

constexpr float turn_rad = 6.283185307f;

Vector3 vector_of(const Triple& values) { return {values[0], values[1], values[2]}; }

float sign(float reversed) { return reversed != 0.0f ? -1.0f : 1.0f; }

Arm arm(const ParameterSet& set) {
  return {set[Parameter::transmission] == 0.0f ? Transmission::serial : Transmission::parallelogram,
          set[Parameter::frame] == 0.0f ? Frame::paper : Frame::omni,
          set[Parameter::link_2_m],
          set[Parameter::link_3_m],
          set[Parameter::elbow_offset_rad],
          vector_of(set.of_each(Parameter::origin_x_m))};
}

EncoderScale encoders(const ParameterSet& set) {
  const Triple counts_per_turn = set.of_each(Parameter::encoder_1_counts_per_turn);
  const Triple ratio = set.of_each(Parameter::gear_ratio_1);
  const Triple reversed = set.of_each(Parameter::encoder_1_reversed);
  EncoderScale scale{{}, set.of_each(Parameter::inkwell_joint_1_rad), 0};
  constexpr float farthest_rad = 100.0f * protocol::servo_period_s;
  float farthest_counts = 15.0f;  // tolerates the dither of a coarse encoder
  for (std::size_t i = 0; i < 3; ++i) {
    const float counts_per_rad = counts_per_turn[i] * ratio[i] / turn_rad;
    scale.rad_per_count[i] = sign(reversed[i]) * turn_rad / (counts_per_turn[i] * ratio[i]);
    farthest_counts = std::max(farthest_counts, farthest_rad * counts_per_rad);
  }
  scale.jump_counts = std::bit_ceil(static_cast<std::uint32_t>(farthest_counts) + 1);
  return scale;
}

std::array<GimbalCurve, 3> gimbal(const ParameterSet& set) {
  const Triple square = set.of_each(Parameter::gimbal_1_square_rad);
  const Triple slope = set.of_each(Parameter::gimbal_1_slope_rad);
  const Triple offset = set.of_each(Parameter::gimbal_1_offset_rad);
  std::array<GimbalCurve, 3> curves{};
  for (std::size_t i = 0; i < 3; ++i) curves[i] = {square[i], slope[i], offset[i]};
  return curves;
}

Box box(const ParameterSet& set) {
  const float radius_m = set[Parameter::sphere_radius_m];
  const Vector3 radius{radius_m, radius_m, radius_m};
  return {vector_of(set.of_each(Parameter::box_minimum_x_m)) + radius,
          vector_of(set.of_each(Parameter::box_maximum_x_m)) - radius};
}

ForceLimit contact_limit(float limit_N) { return {limit_N, limit_N > 0.0f ? 1.0f / limit_N : 0.0f}; }

Surface wall(const ParameterSet& set) {
  const float stiffness_N_per_m = set[Parameter::wall_stiffness_N_per_m];
  return {.stiffness_N_per_m = stiffness_N_per_m,
          .m_per_N = stiffness_N_per_m > 0.0f ? 1.0f / stiffness_N_per_m : 0.0f,
          .damping_Ns_per_m = set[Parameter::wall_damping_Ns_per_m],
          .static_friction = 0.0f,
          .dynamic_friction = 0.0f,
          .viscosity_Ns_per_m = 0.0f};
}

/// Joint torque per ampere of each motor, negative for a reversed motor. The torque per ampere is equal to the back EMF
/// per joint speed, because 1 Nm/A = 1 Vs/rad.
Triple joint_Nm_per_A(const ParameterSet& set) {
  const Triple ratio = set.of_each(Parameter::gear_ratio_1);
  const Triple constant_Nm_per_A = set.of_each(Parameter::torque_constant_1_Nm_per_A);
  const Triple reversed = set.of_each(Parameter::motor_1_reversed);
  Triple joint{};
  for (std::size_t i = 0; i < 3; ++i) joint[i] = sign(reversed[i]) * ratio[i] * constant_Nm_per_A[i];
  return joint;
}

float longer_link_m(const ParameterSet& set) { return std::max(set[Parameter::link_2_m], set[Parameter::link_3_m]); }

Motors motors(const ParameterSet& set) {
  const Triple joint = joint_Nm_per_A(set);
  const Triple continuous_A = set.of_each(Parameter::continuous_current_1_A);
  Motors motors{{}, set.of_each(Parameter::current_limit_1_A), {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    motors.ampere_per_Nm[i] = 1.0f / joint[i];
    motors.ampere_per_N[i] = longer_link_m(set) * std::fabs(motors.ampere_per_Nm[i]);
    const float more_A = motors.current_limit_A[i] - continuous_A[i];
    motors.ampere_per_heat[i] = more_A > 0.0f ? more_A / (1.0f - protocol::motor_heat_limits_from) : 0.0f;
  }
  const bool idle_2 = motors.current_limit_A[1] == 0.0f, idle_3 = motors.current_limit_A[2] == 0.0f;
  if (idle_2 != idle_3) motors.idle = idle_2 ? 1 : 2;
  return motors;
}

MotorModel motor_model(const ParameterSet& set) {
  return {set.of_each(Parameter::motor_resistance_1_ohm), joint_Nm_per_A(set),
          set[Parameter::motors_confirmed] != 0.0f};
}

HeatScale heat(const ParameterSet& set) {
  const Triple continuous_A = set.of_each(Parameter::continuous_current_1_A);
  constexpr auto readings = static_cast<float>(MotorHeat::readings_per_update);
  constexpr float update_period_s = MotorHeat::periods_per_update * protocol::servo_period_s;
  HeatScale scale{{},
                  set[Parameter::winding_heat_part],
                  update_period_s / set[Parameter::winding_time_constant_s],
                  update_period_s / set[Parameter::housing_time_constant_s]};
  for (std::size_t i = 0; i < 3; ++i) {
    scale.per_square_sum[i] = 1.0f / (readings * continuous_A[i] * continuous_A[i]);
  }
  return scale;
}

Limits limits(const ParameterSet& set, const Triple& ampere_per_N) {
  // A lower over-current bound would react to sensor noise.
  constexpr float over_current_minimum_A = 0.5f;
  // Margin of the joint limits for lost counts and elastic stops.
  constexpr float joint_margin_rad = 0.35f;

  Limits limits{set.of_each(protocol::lower_stops),
                set.of_each(protocol::upper_stops),
                set.of_each(Parameter::current_limit_1_A),
                {},
                {},
                InkwellReference::play_m / longer_link_m(set),
                0.0f,
                periods_in(set[Parameter::host_timeout_s])};
  for (std::size_t i = 0; i < 3; ++i) {
    limits.joint_minimum_rad[i] -= joint_margin_rad;
    limits.joint_maximum_rad[i] += joint_margin_rad;
    const float over_A = protocol::over_current_ratio * limits.over_current_A[i];
    limits.over_current_A[i] = over_A > over_current_minimum_A ? over_A : over_current_minimum_A;
    limits.moving_A[i] = StuckEncoder::moving_force_N * ampere_per_N[i];
    limits.brake_A[i] = set[Parameter::force_limit_N] * ampere_per_N[i];
  }
  const float speed_m_per_s = set[Parameter::speed_limit_m_per_s];
  limits.speed_limit_squared_m2_per_s2 = speed_m_per_s * speed_m_per_s;
  return limits;
}

ForceLawValues force_law(const ParameterSet& set) {
  ForceLawValues values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = set.values[protocol::parameter_count + i];
  return values;
}

ProgramForceLimits program_force(const ParameterSet& set) {
  const float change_N_per_period = set[Parameter::program_force_change_N_per_s] * protocol::servo_period_s;
  return {set[Parameter::force_limit_N], change_N_per_period, 1.0f / change_N_per_period,
          periods_in(set[Parameter::program_force_expiry_s])};
}

/// A force jump fades at 4 % of the force limit per millisecond. A jump of force_limit_N fades in 25 ms.
constexpr float recovery_per_s = 0.04f * 1000.0f;

/// Change of the force gain in one period. A ramp time of less than one period results in a step.
float ramp_per_period(float ramp_s) {
  return ramp_s > protocol::servo_period_s ? protocol::servo_period_s / ramp_s : 1.0f;
}

float squared(float value) { return value * value; }

EnergyLimits energy(const ParameterSet& set) {
  const float reserve_J = set[Parameter::energy_reserve_J];
  return {reserve_J, set[Parameter::power_given_W] * protocol::servo_period_s,
          1.0f / (EnergyReserve::low_part * reserve_J)};
}

SpeedLimit speed(const ParameterSet& set) {
  const float from_squared = squared(protocol::speed_limits_from * set[Parameter::speed_limit_m_per_s]);
  const float whole_squared = squared(protocol::speed_stops_driving_from * set[Parameter::speed_limit_m_per_s]);
  return {from_squared, 1.0f / (whole_squared - from_squared)};
}

}  // namespace

PulseSize PulseSize::of(const Triple& resistance_ohm) {
  constexpr float shortest = SelfTestPulses::level_periods, longest = SelfTestPulses::level_maximum_periods;
  constexpr float ohm_for_shortest = 2.0f;
  PulseSize size{resistance_ohm, {}};
  for (std::size_t i = 0; i < 3; ++i)
    size.level_periods[i] =
        static_cast<std::uint32_t>(std::clamp(shortest * ohm_for_shortest / resistance_ohm[i], shortest, longest));
  return size;
}

Settings prepare(const ParameterSet& parameters) {
  const Motors all_motors = motors(parameters);
  return {.arm = arm(parameters),
          .encoders = encoders(parameters),
          .gimbal = gimbal(parameters),
          .box = box(parameters),
          .wall = wall(parameters),
          .force_law = force_law(parameters),
          .force_limit_N = parameters[Parameter::force_limit_N],
          .contact_limit = contact_limit(parameters[Parameter::force_limit_N]),
          .recovery_N_per_period = recovery_per_s * protocol::servo_period_s * parameters[Parameter::force_limit_N],
          .program_force = program_force(parameters),
          .ramp_per_period = ramp_per_period(parameters[Parameter::force_ramp_s]),
          .landing_per_period = ramp_per_period(parameters[Parameter::soft_landing_s]),
          .change_squared_N2 = squared(parameters[Parameter::force_change_N_per_s] * protocol::servo_period_s),
          .energy = energy(parameters),
          .speed = speed(parameters),
          .motors = all_motors,
          .heat = heat(parameters),
          .motor_model = motor_model(parameters),
          .current_loop = {parameters[Parameter::current_proportional_gain_V_per_A],
                           parameters[Parameter::current_integral_gain_V_per_As] * protocol::servo_period_s * 0.5f,
                           parameters[Parameter::voltage_limit_V]},
          .limits = limits(parameters, all_motors.ampere_per_N)};
}

}  // namespace inkwell::control
