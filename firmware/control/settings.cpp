#include <control/settings.hpp>

#include <control/conditioning.hpp>

namespace inkwell::control {

namespace {

using protocol::Parameter;
using protocol::ParameterSet;

constexpr float turn_rad = 6.283185307f;

/// The three rows of the table that stand one behind the other for joints or motors 1 to 3.
Triple rows(const ParameterSet& set, Parameter first, std::size_t stride = 1) {
  const auto index = static_cast<std::size_t>(first);
  return {set.values[index], set.values[index + stride], set.values[index + 2 * stride]};
}

constexpr int distance(Parameter from, Parameter to) { return static_cast<int>(to) - static_cast<int>(from); }

static_assert(distance(Parameter::gear_ratio_1, Parameter::gear_ratio_3) == 2 &&
                  distance(Parameter::joint_1_minimum_rad, Parameter::joint_2_minimum_rad) == 2 &&
                  distance(Parameter::joint_1_minimum_rad, Parameter::elbow_minimum_rad) == 4 &&
                  distance(Parameter::box_minimum_x_m, Parameter::box_minimum_y_m) == 2 &&
                  distance(Parameter::gimbal_1_square_rad, Parameter::gimbal_2_square_rad) == 3,
              "rows() relies on the order of the table");

Vector3 vector_of(const Triple& values) { return {values[0], values[1], values[2]}; }

float sign(float reversed) { return reversed != 0.0f ? -1.0f : 1.0f; }

Arm arm(const ParameterSet& set) {
  return {set[Parameter::transmission] == 0.0f ? Transmission::serial : Transmission::parallelogram,
          set[Parameter::frame] == 0.0f ? Frame::paper : Frame::omni,
          set[Parameter::link_2_m],
          set[Parameter::link_3_m],
          set[Parameter::elbow_offset_rad],
          vector_of(rows(set, Parameter::origin_x_m))};
}

EncoderScale encoders(const ParameterSet& set) {
  const Triple counts_per_turn = rows(set, Parameter::encoder_1_counts_per_turn);
  const Triple ratio = rows(set, Parameter::gear_ratio_1);
  const Triple reversed = rows(set, Parameter::encoder_1_reversed);
  EncoderScale scale{{}, rows(set, Parameter::inkwell_joint_1_rad)};
  for (std::size_t i = 0; i < 3; ++i)
    scale.rad_per_count[i] = sign(reversed[i]) * turn_rad / (counts_per_turn[i] * ratio[i]);
  return scale;
}

std::array<GimbalCurve, 3> gimbal(const ParameterSet& set) {
  const Triple square = rows(set, Parameter::gimbal_1_square_rad, 3);
  const Triple slope = rows(set, Parameter::gimbal_1_slope_rad, 3);
  const Triple offset = rows(set, Parameter::gimbal_1_offset_rad, 3);
  std::array<GimbalCurve, 3> curves{};
  for (std::size_t i = 0; i < 3; ++i) curves[i] = {square[i], slope[i], offset[i]};
  return curves;
}

Box box(const ParameterSet& set) {
  const float radius_m = set[Parameter::sphere_radius_m];
  const Vector3 radius{radius_m, radius_m, radius_m};
  return {vector_of(rows(set, Parameter::box_minimum_x_m, 2)) + radius,
          vector_of(rows(set, Parameter::box_maximum_x_m, 2)) - radius};
}

Motors motors(const ParameterSet& set) {
  const Triple ratio = rows(set, Parameter::gear_ratio_1);
  const Triple constant_Nm_per_A = rows(set, Parameter::torque_constant_1_Nm_per_A);
  const Triple reversed = rows(set, Parameter::motor_1_reversed);
  Motors motors{{}, rows(set, Parameter::current_limit_1_A)};
  for (std::size_t i = 0; i < 3; ++i) motors.ampere_per_Nm[i] = sign(reversed[i]) / (ratio[i] * constant_Nm_per_A[i]);
  return motors;
}

HeatScale heat(const ParameterSet& set) {
  const Triple continuous_A = rows(set, Parameter::continuous_current_1_A);
  constexpr auto readings = static_cast<float>(MotorHeat::readings_per_update);
  constexpr float update_period_s = MotorHeat::periods_per_update * protocol::servo_period_s;
  HeatScale scale{{}, update_period_s / set[Parameter::winding_time_constant_s]};
  for (std::size_t i = 0; i < 3; ++i) scale.per_square_sum[i] = 1.0f / (readings * continuous_A[i] * continuous_A[i]);
  return scale;
}

Limits limits(const ParameterSet& set) {
  // Half above the limit, but never so low that the sensors' noise reaches it. Where this is more than the board can
  // measure, the board's bound comes first (BoardLimits).
  constexpr float over_current_ratio = 1.5f;
  constexpr float over_current_minimum_A = 0.5f;
  // Counts may be lost or the stops yield a little before the angles are called impossible.
  constexpr float joint_margin_rad = 0.35f;

  Limits limits{rows(set, Parameter::joint_1_minimum_rad, 2), rows(set, Parameter::joint_1_maximum_rad, 2),
                rows(set, Parameter::current_limit_1_A), 0.0f, periods_in(set[Parameter::host_timeout_s])};
  for (std::size_t i = 0; i < 3; ++i) {
    limits.joint_minimum_rad[i] -= joint_margin_rad;
    limits.joint_maximum_rad[i] += joint_margin_rad;
    const float over_A = over_current_ratio * limits.over_current_A[i];
    limits.over_current_A[i] = over_A > over_current_minimum_A ? over_A : over_current_minimum_A;
  }
  const float speed_m_per_s = set[Parameter::speed_limit_m_per_s];
  limits.speed_limit_squared_m2_per_s2 = speed_m_per_s * speed_m_per_s;
  return limits;
}

/// Rise of the force's gain in one period; a ramp of less than a period is a step.
float ramp_per_period(float ramp_s) {
  return ramp_s > protocol::servo_period_s ? protocol::servo_period_s / ramp_s : 1.0f;
}

}  // namespace

Settings prepare(const ParameterSet& parameters) {
  return {.arm = arm(parameters),
          .encoders = encoders(parameters),
          .gimbal = gimbal(parameters),
          .box = box(parameters),
          .wall = {parameters[Parameter::wall_stiffness_N_per_m], parameters[Parameter::wall_damping_Ns_per_m],
                   parameters[Parameter::force_limit_N]},
          .ramp_per_period = ramp_per_period(parameters[Parameter::force_ramp_s]),
          .motors = motors(parameters),
          .heat = heat(parameters),
          .current_loop = {parameters[Parameter::current_proportional_gain_V_per_A],
                           parameters[Parameter::current_integral_gain_V_per_As] * protocol::servo_period_s * 0.5f,
                           parameters[Parameter::voltage_limit_V]},
          .limits = limits(parameters)};
}

}  // namespace inkwell::control
