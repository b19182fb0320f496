// Table of all parameters. Firmware, companion, saved files, arm descriptions and documentation use this table.
//
//   X(id, name, kind, unit, minimum, maximum, default, group, help)
//
// The protocol transmits `id`. An id never changes its meaning, and the id of a removed parameter is not reused. `name`
// ends in the unit, and files and command line use the same name.
//
// A row with the default arm_defaults::NAME describes the arm. Every file in boards/arms/ sets all parameters of the
// arm. The build selects one arm description and writes its values to the generated header <arm/defaults.hpp>.
//
// The parameters of the image's force law follow the last row (docs/force-laws.md).
#pragma once

// To add a parameter:
// (1) Add a row with a new id below the last row of its group. The group "arm" is for parameters that must not change
//     while the force is on (needs_force_off()).
// (2) For a parameter of the arm, set the default to arm_defaults::NAME and add the key NAME to each
//     boards/arms/*.toml.
// (3) If one parameter must be above another parameter, add the pair to parameter_bounds.
// (4) For a choice other than no and yes, add the names to choice_names() in
//     host/companion/window/panes/tuning_pane.cpp.
// (5) Add a member to control::Settings (settings.hpp) and compute the member in firmware/control/settings.cpp.
//     control::Controller passes the settings to the signal path. If the parameter changes the wall force, also change
//     the independent wall law of the experiment's summary (host/lab/experiment/summary.cpp).
// (6) Choose a default that does not change the force, so that existing tests pass unchanged.
// (7) Build `board` and `pc-tests`. PC programs refuse a firmware that was built with another table.
//
// Sliders, command line, files and help texts use this table.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <arm/defaults.hpp>
#include "protocol/added_rows.hpp"
#include "protocol/each_axis.hpp"

namespace inkwell::protocol {

enum class ParameterKind : std::uint8_t {
  real,    ///< any value in the range
  whole,   ///< a whole number in the range
  choice,  ///< a whole number; the help text names each value
};

// clang-format off
#define INKWELL_PARAMETERS(X)                                                                                                    \
  X(100, box_minimum_x_m, real, "m", -0.5f, 0.5f, arm_defaults::box_minimum_x_m, "box", "Lower wall of the box along x. The free space is above the wall.") \
  X(101, box_maximum_x_m, real, "m", -0.5f, 0.5f, arm_defaults::box_maximum_x_m, "box", "Upper wall of the box along x. The free space is below the wall.") \
  X(102, box_minimum_y_m, real, "m", -0.5f, 0.5f, arm_defaults::box_minimum_y_m, "box", "Lower wall of the box along y.")         \
  X(103, box_maximum_y_m, real, "m", -0.5f, 0.5f, arm_defaults::box_maximum_y_m, "box", "Upper wall of the box along y.")         \
  X(104, box_minimum_z_m, real, "m", -0.5f, 0.5f, arm_defaults::box_minimum_z_m, "box", "Lower wall of the box along z.")         \
  X(105, box_maximum_z_m, real, "m", -0.5f, 0.5f, arm_defaults::box_maximum_z_m, "box", "Upper wall of the box along z.")         \
  X(200, sphere_radius_m, real, "m", 0.0f, 0.02f, 0.005f, "contact", "Radius of the sphere that touches the walls. With 0 the probe is a point.") \
  X(201, wall_stiffness_N_per_m, real, "N/m", 0.0f, 3000.0f, 800.0f, "contact", "Spring constant k of the walls (paper, section 3.3).") \
  X(202, wall_damping_Ns_per_m, real, "Ns/m", 0.0f, 20.0f, 2.0f, "contact", "Damping constant c of the walls (paper, section 3.3). Damping acts only in contact.") \
  X(203, force_limit_N, real, "N", 0.0f, 8.0f, 3.3f, "contact", "Upper limit of the force on the hand.")    \
  X(204, force_ramp_s, real, "s", 0.0f, 2.0f, 0.25f, "contact", "Time in which the force rises from zero to its full value after it is switched on.") \
  X(205, soft_landing_s, real, "s", 0.0f, 1.0f, 0.05f, "contact", "Time in which the force falls to zero after the command to switch it off. A stop, a fault or the loss of the host removes the force immediately.") \
  X(206, force_change_N_per_s, real, "N/s", 100.0f, 100000.0f, 5000.0f, "contact", "Largest rate of change of the force, for all force sources. Faster changes are slowed down to this rate.") \
  X(207, energy_reserve_J, real, "J", 0.001f, 1.0f, 0.05f, "contact", "Largest energy that the arm may deliver to the hand in addition to the energy received from the hand. The reserve is full when the force is switched on. The hand's work and power_given_W refill the reserve. A test pulse ends when it has delivered this energy.") \
  X(208, power_given_W, real, "W", 0.0f, 20.0f, 1.0f, "contact", "Power that the arm may deliver to the hand continuously. When the energy reserve is empty, the force component along the motion is reduced to this power. Walls do not need this power.") \
  X(220, program_force_expiry_s, real, "s", 0.005f, 0.5f, 0.05f, "program force", "Time without a force report after which the force of the program fades to zero within 10 ms.") \
  X(221, program_force_change_N_per_s, real, "N/s", 1.0f, 20000.0f, 1000.0f, "program force", "Largest rate of change of the force that a program requests. Faster changes are slowed down to this rate.") \
  X(300, current_proportional_gain_V_per_A, real, "V/A", 0.0f, 10.0f, arm_defaults::current_proportional_gain_V_per_A, "current loop", "Proportional gain of the current loops: inductance times desired bandwidth in rad/s.") \
  X(301, current_integral_gain_V_per_As, real, "V/(As)", 0.0f, 60000.0f, arm_defaults::current_integral_gain_V_per_As, "current loop", "Integral gain of the current loops: resistance times desired bandwidth in rad/s.") \
  X(302, voltage_limit_V, real, "V", 0.0f, 24.0f, 16.0f, "current loop", "Largest voltage that a current loop may apply to a motor. The supply voltage is a further limit.") \
  X(303, motor_resistance_1_ohm, real, "ohm", 0.1f, 100.0f, arm_defaults::motor_resistance_1_ohm, "current loop", "Winding resistance of motor 1. The self-test fails if the measured resistance differs too much from this value. The motor check uses this value until a self-test has measured the resistance. `inkwell tune current-loop` measures it.") \
  X(304, motor_resistance_2_ohm, real, "ohm", 0.1f, 100.0f, arm_defaults::motor_resistance_2_ohm, "current loop", "Winding resistance of motor 2.") \
  X(305, motor_resistance_3_ohm, real, "ohm", 0.1f, 100.0f, arm_defaults::motor_resistance_3_ohm, "current loop", "Winding resistance of motor 3.") \
  X(400, current_limit_1_A, real, "A", 0.0f, 3.0f, arm_defaults::current_limit_1_A, "limits", "Current limit of motor 1. When one motor reaches its limit, all motor currents are scaled down together. A motor with limit 0 is not used.") \
  X(401, current_limit_2_A, real, "A", 0.0f, 3.0f, arm_defaults::current_limit_2_A, "limits", "Current limit of motor 2.") \
  X(402, current_limit_3_A, real, "A", 0.0f, 3.0f, arm_defaults::current_limit_3_A, "limits", "Current limit of motor 3.") \
  X(403, speed_limit_m_per_s, real, "m/s", 0.1f, 10.0f, 3.0f, "limits", "Probe speed above which a fault switches the force off. The force component along the motion is reduced above 80 % of this speed and is zero above 90 %.") \
  X(404, host_timeout_s, real, "s", 0.01f, 2.0f, 0.05f, "limits", "Time without a report from the host after which the force is switched off.")    \
  X(405, continuous_current_1_A, real, "A", 0.2f, 3.0f, arm_defaults::continuous_current_1_A, "limits", "Continuous current rating of motor 1. Motor heat is reported relative to the heat at this current. Above 85 % heat the current limit falls, and at 100 % it equals this current. A change of this parameter does not change the reported heat.") \
  X(406, continuous_current_2_A, real, "A", 0.2f, 3.0f, arm_defaults::continuous_current_2_A, "limits", "Continuous current rating of motor 2.") \
  X(407, continuous_current_3_A, real, "A", 0.2f, 3.0f, arm_defaults::continuous_current_3_A, "limits", "Continuous current rating of motor 3.") \
  X(408, winding_time_constant_s, real, "s", 0.25f, 1000.0f, arm_defaults::winding_time_constant_s, "limits", "Thermal time constant of the winding relative to the housing (63 % of a step).") \
  X(409, housing_time_constant_s, real, "s", 0.25f, 2000.0f, arm_defaults::housing_time_constant_s, "limits", "Thermal time constant of the housing relative to the room (63 % of a step).") \
  X(410, winding_heat_part, real, "", 0.01f, 1.0f, arm_defaults::winding_heat_part, "limits", "Thermal resistance from winding to housing, divided by the thermal resistance from winding to room.") \
  X(500, transmission, choice, "", 0.0f, 1.0f, arm_defaults::transmission, "arm", "Transmission from motor 3 to link 3: 0 serial (joint 3 is relative to link 2), 1 parallelogram (joint 3 is absolute).") \
  X(501, frame, choice, "", 0.0f, 1.0f, arm_defaults::frame, "arm", "Axes of the workspace: 0 as in the paper (x forward, y left, z up), 1 as on the Omni (x right, y up, z to the user).") \
  X(502, link_2_m, real, "m", 0.02f, 1.0f, arm_defaults::link_2_m, "arm", "Length of link 2, shoulder to elbow (a2 of the paper's Table 1).") \
  X(503, link_3_m, real, "m", 0.02f, 1.0f, arm_defaults::link_3_m, "arm", "Length of link 3, elbow to probe (a3 of the paper's Table 1).") \
  X(504, elbow_offset_rad, real, "rad", -3.2f, 3.2f, arm_defaults::elbow_offset_rad, "arm", "Offset from the angle of joint 3 to the direction of link 3 in the plane of the arm.") \
  X(505, origin_x_m, real, "m", -1.0f, 1.0f, arm_defaults::origin_x_m, "arm", "Shoulder position in the workspace, x.")        \
  X(506, origin_y_m, real, "m", -1.0f, 1.0f, arm_defaults::origin_y_m, "arm", "Shoulder position in the workspace, y.")        \
  X(507, origin_z_m, real, "m", -1.0f, 1.0f, arm_defaults::origin_z_m, "arm", "Shoulder position in the workspace, z.")        \
  X(510, encoder_1_counts_per_turn, whole, "counts", 4.0f, 1000000.0f, arm_defaults::encoder_1_counts_per_turn, "arm", "Quadrature counts (four per line) of encoder 1 per turn of its motor.") \
  X(511, encoder_2_counts_per_turn, whole, "counts", 4.0f, 1000000.0f, arm_defaults::encoder_2_counts_per_turn, "arm", "Quadrature counts (four per line) of encoder 2 per turn of its motor.") \
  X(512, encoder_3_counts_per_turn, whole, "counts", 4.0f, 1000000.0f, arm_defaults::encoder_3_counts_per_turn, "arm", "Quadrature counts (four per line) of encoder 3 per turn of its motor.") \
  X(520, gear_ratio_1, real, "", 0.1f, 1000.0f, arm_defaults::gear_ratio_1, "arm", "Turns of motor 1 per turn of joint 1.")    \
  X(521, gear_ratio_2, real, "", 0.1f, 1000.0f, arm_defaults::gear_ratio_2, "arm", "Turns of motor 2 per turn of joint 2.")    \
  X(522, gear_ratio_3, real, "", 0.1f, 1000.0f, arm_defaults::gear_ratio_3, "arm", "Turns of motor 3 per turn of joint 3.")    \
  X(530, encoder_1_reversed, choice, "", 0.0f, 1.0f, arm_defaults::encoder_1_reversed, "arm", "1 if encoder 1 counts down when joint 1 turns forward, else 0.") \
  X(531, encoder_2_reversed, choice, "", 0.0f, 1.0f, arm_defaults::encoder_2_reversed, "arm", "1 if encoder 2 counts down when joint 2 turns forward, else 0.") \
  X(532, encoder_3_reversed, choice, "", 0.0f, 1.0f, arm_defaults::encoder_3_reversed, "arm", "1 if encoder 3 counts down when joint 3 turns forward, else 0.") \
  X(533, motor_1_reversed, choice, "", 0.0f, 1.0f, arm_defaults::motor_1_reversed, "arm", "1 if a positive current turns joint 1 backward, else 0.") \
  X(534, motor_2_reversed, choice, "", 0.0f, 1.0f, arm_defaults::motor_2_reversed, "arm", "1 if a positive current turns joint 2 backward, else 0.") \
  X(535, motor_3_reversed, choice, "", 0.0f, 1.0f, arm_defaults::motor_3_reversed, "arm", "1 if a positive current turns joint 3 backward, else 0.") \
  X(540, torque_constant_1_Nm_per_A, real, "Nm/A", 0.001f, 1.0f, arm_defaults::torque_constant_1_Nm_per_A, "arm", "Torque at the shaft of motor 1 per ampere.") \
  X(541, torque_constant_2_Nm_per_A, real, "Nm/A", 0.001f, 1.0f, arm_defaults::torque_constant_2_Nm_per_A, "arm", "Torque at the shaft of motor 2 per ampere.") \
  X(542, torque_constant_3_Nm_per_A, real, "Nm/A", 0.001f, 1.0f, arm_defaults::torque_constant_3_Nm_per_A, "arm", "Torque at the shaft of motor 3 per ampere.") \
  X(550, joint_1_minimum_rad, real, "rad", -6.3f, 6.3f, arm_defaults::joint_1_minimum_rad, "arm", "Lower stop of joint 1.")        \
  X(551, joint_1_maximum_rad, real, "rad", -6.3f, 6.3f, arm_defaults::joint_1_maximum_rad, "arm", "Upper stop of joint 1.")        \
  X(552, joint_2_minimum_rad, real, "rad", -6.3f, 6.3f, arm_defaults::joint_2_minimum_rad, "arm", "Lower stop of joint 2.")        \
  X(553, joint_2_maximum_rad, real, "rad", -6.3f, 6.3f, arm_defaults::joint_2_maximum_rad, "arm", "Upper stop of joint 2.")        \
  X(554, elbow_minimum_rad, real, "rad", -6.3f, 6.3f, arm_defaults::elbow_minimum_rad, "arm", "Lower stop of the elbow: joint 3 of a serial arm, joint 3 minus joint 2 of a parallelogram.") \
  X(555, elbow_maximum_rad, real, "rad", -6.3f, 6.3f, arm_defaults::elbow_maximum_rad, "arm", "Upper stop of the elbow: joint 3 of a serial arm, joint 3 minus joint 2 of a parallelogram.") \
  X(560, inkwell_joint_1_rad, real, "rad", -6.3f, 6.3f, arm_defaults::inkwell_joint_1_rad, "arm", "Angle of joint 1 while the stylus is in the inkwell.") \
  X(561, inkwell_joint_2_rad, real, "rad", -6.3f, 6.3f, arm_defaults::inkwell_joint_2_rad, "arm", "Angle of joint 2 while the stylus is in the inkwell.") \
  X(562, inkwell_joint_3_rad, real, "rad", -6.3f, 6.3f, arm_defaults::inkwell_joint_3_rad, "arm", "Angle of joint 3 while the stylus is in the inkwell.") \
  X(600, gimbal_1_square_rad, real, "rad", -10.0f, 10.0f, arm_defaults::gimbal_1_square_rad, "gimbal", "Square term of the yaw potentiometer: yaw = square r^2 + slope r + offset, where r is the wiper voltage divided by the supply voltage.") \
  X(601, gimbal_1_slope_rad, real, "rad", -20.0f, 20.0f, arm_defaults::gimbal_1_slope_rad, "gimbal", "Slope of the yaw potentiometer.") \
  X(602, gimbal_1_offset_rad, real, "rad", -20.0f, 20.0f, arm_defaults::gimbal_1_offset_rad, "gimbal", "Offset of the yaw potentiometer.") \
  X(603, gimbal_2_square_rad, real, "rad", -10.0f, 10.0f, arm_defaults::gimbal_2_square_rad, "gimbal", "Square term of the pitch potentiometer.") \
  X(604, gimbal_2_slope_rad, real, "rad", -20.0f, 20.0f, arm_defaults::gimbal_2_slope_rad, "gimbal", "Slope of the pitch potentiometer.") \
  X(605, gimbal_2_offset_rad, real, "rad", -20.0f, 20.0f, arm_defaults::gimbal_2_offset_rad, "gimbal", "Offset of the pitch potentiometer.") \
  X(606, gimbal_3_square_rad, real, "rad", -10.0f, 10.0f, arm_defaults::gimbal_3_square_rad, "gimbal", "Square term of the roll potentiometer.") \
  X(607, gimbal_3_slope_rad, real, "rad", -20.0f, 20.0f, arm_defaults::gimbal_3_slope_rad, "gimbal", "Slope of the roll potentiometer.") \
  X(608, gimbal_3_offset_rad, real, "rad", -20.0f, 20.0f, arm_defaults::gimbal_3_offset_rad, "gimbal", "Offset of the roll potentiometer.")
// clang-format on

/// Index of a parameter in the table. The protocol transmits the id instead of the index. Values after the last
/// enumerator are parameters of the force law.
enum class Parameter : std::uint8_t {
#define X(id, name, ...) name,
  INKWELL_PARAMETERS(X)
#undef X
};

struct ParameterInfo {
  std::uint16_t id;       ///< id in the protocol
  std::string_view name;  ///< ends in its unit
  ParameterKind kind;
  std::string_view unit;  ///< empty for a dimensionless parameter
  float minimum;
  float maximum;
  float default_value;
  std::string_view group;
  std::string_view help;
  bool belongs_to_arm;  ///< true if every arm description sets it
};

namespace detail {
constexpr bool is_from_arm(std::string_view default_value) { return default_value.starts_with("arm_defaults::"); }
}  // namespace detail

inline constexpr auto parameter_table = std::to_array<ParameterInfo>({
#define X(id, name, kind, unit, minimum, maximum, default_value, group, help) \
  {id,                                                                        \
   #name,                                                                     \
   ParameterKind::kind,                                                       \
   unit,                                                                      \
   minimum,                                                                   \
   maximum,                                                                   \
   default_value,                                                             \
   group,                                                                     \
   help,                                                                      \
   detail::is_from_arm(#default_value)},
    INKWELL_PARAMETERS(X)
#undef X
});

inline constexpr std::size_t parameter_count = parameter_table.size();

/// Largest number of force law parameters, and the id of the first force law parameter.
inline constexpr std::size_t force_law_parameters_maximum = 12;
inline constexpr std::uint16_t force_law_first_id = 1000;

/// Returns the table, followed by the parameters of a known force law.
inline KnownRows<ParameterInfo, parameter_count> known_parameters() { return KnownRows(parameter_table); }

constexpr const ParameterInfo& info(Parameter parameter) {
  const auto place = static_cast<std::size_t>(parameter);
  return place < parameter_count ? parameter_table[place] : known_parameters()[place];
}
constexpr std::size_t row_count(Parameter) { return parameter_count; }
/// True if the parameter is part of the arm's geometry. A change of the geometry would make the force jump, and is
/// therefore allowed only while the force is off. Parameters outside the group "arm" can change at any time, even if
/// belongs_to_arm is set.
constexpr bool needs_force_off(const ParameterInfo& row) { return row.group == "arm"; }
constexpr bool alike(const ParameterInfo& a, const ParameterInfo& b) {
  return a.kind == b.kind && a.unit == b.unit && a.minimum == b.minimum && a.maximum == b.maximum &&
         a.group == b.group && a.belongs_to_arm == b.belongs_to_arm;
}

/// Returns the parameter of motor, joint or axis `axis` (0, 1 or 2). `rows` is the parameter with index 0.
constexpr Parameter of_axis(EachAxis<Parameter> rows, std::size_t axis) { return rows[axis]; }
/// Returns the parameter of motor, joint or axis `number` (1, 2 or 3, as in the row names).
constexpr Parameter of_number(EachAxis<Parameter> rows, int number) {
  return rows[static_cast<std::size_t>(number) - 1];
}

/// Joint stops of the arm. On every arm, the third pair bounds the angle between the links.
inline constexpr EachAxis<Parameter> lower_stops{Parameter::joint_1_minimum_rad, Parameter::joint_2_minimum_rad,
                                                 Parameter::elbow_minimum_rad};
inline constexpr EachAxis<Parameter> upper_stops{Parameter::joint_1_maximum_rad, Parameter::joint_2_maximum_rad,
                                                 Parameter::elbow_maximum_rad};

struct Bounds {
  Parameter lower;
  Parameter upper;
  /// If true, `upper` must exceed `lower` by more than the sphere's diameter. If false, `upper` may exceed `lower` by
  /// any amount.
  bool hold_sphere;
};

/// Every set of parameters must satisfy these conditions, in addition to the range of each parameter.
inline constexpr Bounds parameter_bounds[] = {
    {Parameter::box_minimum_x_m, Parameter::box_maximum_x_m, true},
    {Parameter::box_minimum_y_m, Parameter::box_maximum_y_m, true},
    {Parameter::box_minimum_z_m, Parameter::box_maximum_z_m, true},
    {Parameter::joint_1_minimum_rad, Parameter::joint_1_maximum_rad, false},
    {Parameter::joint_2_minimum_rad, Parameter::joint_2_maximum_rad, false},
    {Parameter::elbow_minimum_rad, Parameter::elbow_maximum_rad, false},
};

/// Values of all parameters in table order, followed by the parameters of the force law. Unused values are 0.
struct ParameterSet {
  std::array<float, parameter_count + force_law_parameters_maximum> values;

  constexpr float& operator[](Parameter parameter) { return values[static_cast<std::size_t>(parameter)]; }
  constexpr float operator[](Parameter parameter) const { return values[static_cast<std::size_t>(parameter)]; }
  constexpr std::array<float, 3> of_each(EachAxis<Parameter> rows) const {
    return {(*this)[rows[0]], (*this)[rows[1]], (*this)[rows[2]]};
  }
  bool operator==(const ParameterSet&) const = default;
};

/// Returns the defaults of the table, without the parameters of the force law.
constexpr ParameterSet table_defaults() {
  ParameterSet set{};
  for (std::size_t i = 0; i < parameter_count; ++i) set.values[i] = parameter_table[i].default_value;
  return set;
}

/// Returns the defaults of the table, followed by the defaults of a known force law.
inline ParameterSet default_parameters() {
  ParameterSet set{};
  const auto rows = known_parameters();
  for (std::size_t i = 0; i < rows.size(); ++i) set.values[i] = rows[i].default_value;
  return set;
}

inline std::optional<Parameter> find_parameter(std::uint16_t id) {
  const auto rows = known_parameters();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].id == id) return static_cast<Parameter>(i);
  return std::nullopt;
}

inline std::optional<Parameter> find_parameter(std::string_view name) {
  const auto rows = known_parameters();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].name == name) return static_cast<Parameter>(i);
  return std::nullopt;
}

namespace detail {
template <class Table>
constexpr bool id_rises(const Table& table, std::size_t row) {
  return row == 0 || table[row - 1].id < table[row].id;
}
template <class Table>
constexpr bool default_is_in_range(const Table& table, std::size_t row) {
  return table[row].minimum <= table[row].default_value && table[row].default_value <= table[row].maximum;
}
template <class Table>
constexpr bool is_contiguous_with_its_group(const Table& table, std::size_t row) {
  if (row == 0 || table[row - 1].group == table[row].group) return true;
  for (std::size_t earlier = 0; earlier < row; ++earlier)
    if (table[earlier].group == table[row].group) return false;
  return true;
}
}  // namespace detail
#define X(id, name, kind, unit, minimum, maximum, default_value, group, help)                                       \
  static_assert((id) < force_law_first_id, #name ": the id is reserved for force law parameters");                  \
  static_assert(detail::id_rises(parameter_table, static_cast<std::size_t>(Parameter::name)),                       \
                #name ": the id must be greater than the id of the previous row");                                  \
  static_assert(detail::default_is_in_range(parameter_table, static_cast<std::size_t>(Parameter::name)),            \
                #name ": the default is outside the range");                                                        \
  static_assert(detail::is_contiguous_with_its_group(parameter_table, static_cast<std::size_t>(Parameter::name)),   \
                #name ": the row must follow the other rows of its group, with an id of that group");               \
  static_assert(!detail::is_from_arm(#default_value) || #default_value == std::string_view{"arm_defaults::" #name}, \
                #name ": the default belongs to another row");                                                      \
  static_assert(detail::neighbors_are_alike(parameter_table, static_cast<std::size_t>(Parameter::name)),            \
                #name ": the rows 1 to 3, or x to z, must all exist and agree in kind, unit, range and group");
INKWELL_PARAMETERS(X)
#undef X

}  // namespace inkwell::protocol
