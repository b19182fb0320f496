#include "host/bindings/dropins/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace inkwell::dropins {
namespace {

constexpr double tabletop_offset_mm = 110.0;  // height of the origin above the table
constexpr double input_axes = 6, output_axes = 3;
/// HDAPI reports the gimbal angles as encoder counts with this resolution.
constexpr double gimbal_counts_per_turn = 4096;
constexpr int button_1 = 1, button_2 = 2;
constexpr double status_light_maximum = 7;

void put(const Vector& vector, double scale, double* values) {
  for (std::size_t i = 0; i < 3; ++i) values[i] = scale * vector[i];
}

void put(const double (&vector)[3], double scale, double* values) {
  for (std::size_t i = 0; i < 3; ++i) values[i] = scale * vector[i];
}

void put(const Workspace& workspace, double* values) {
  put(workspace.minimum_m, 1e3, values);
  put(workspace.maximum_m, 1e3, values + 3);
}

const inkwell_pose& pose(const Source& source) { return source.moment->pose; }
const Command& command(const Source& source) { return source.moment->command; }
const ArmFacts& facts(const Source& source) { return source.device->facts(); }

void read_transform(const Source& source, double* values) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) values[4 * column + row] = pose(source).rotation[3 * row + column];
  put(pose(source).position_m, 1e3, values + 12);
  values[3] = values[7] = values[11] = 0.0;
  values[15] = 1.0;
}

void read_encoders(const Source& source, double* values) {
  for (std::size_t i = 0; i < 3; ++i) {
    values[i] = std::round(pose(source).joint_rad[i] * facts(source).encoder_counts_per_rad[i]);
    values[3 + i] = std::round(pose(source).gimbal_rad[i] * gimbal_counts_per_turn / (2.0 * std::numbers::pi));
  }
}

/// The first three rows are the linear velocity in mm/s. The last three rows are 0, because the three joints do not
/// determine the angular velocity.
void read_jacobian(const Source& source, double* values) {
  const auto jacobian = jacobian_at(source.device->arm(), pose(source).joint_rad);
  std::fill_n(values, values_maximum, 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t joint = 0; joint < 3; ++joint) values[6 * axis + joint] = 1e3 * jacobian[3 * axis + joint];
}

void read_joints(const Source& source, double* values) {
  put(pose(source).joint_rad, 1.0, values);
  if (!facts(source).third_is_absolute) values[2] += values[1];
}

template <Vector Command::*member>
bool write_vector(Device& device, const double* values) {
  device.command().*member = {values[0], values[1], values[2]};
  return true;
}

template <std::optional<Vector> Command::*member>
bool write_optional(Device& device, const double* values) {
  device.command().*member = Vector{values[0], values[1], values[2]};
  return true;
}

template <double Settings::*member>
bool write_positive(Device& device, const double* values) {
  if (values[0] <= 0.0) return false;
  device.settings.*member = values[0];
  return true;
}

bool write_motor_values(Device& device, const double* values) {
  constexpr double lowest = -32767, highest = 32766;
  if (!std::all_of(values, values + 3, [&](double value) { return value >= lowest && value <= highest; })) return false;
  device.command().motor_values = {values[0], values[1], values[2], 0.0, 0.0, 0.0};
  return true;
}

bool write_status_light(Device& device, const double* values) {
  if (values[0] < 0.0 || values[0] > status_light_maximum) return false;
  device.settings.status_light = values[0];
  return true;
}

std::string simulation_mark(const Source& source) {
  return source.device->information().is_virtual != 0 ? " (simulation)" : "";
}

// clang-format off: the table has aligned columns.
const Parameter table[] = {
    {0x2000, 0x2200, "CURRENT_BUTTONS", "", 1, type_integer, "bit mask: 1 is button 1, 2 is button 2",
     [](const Source& s, double* v) { *v = (pose(s).button_1 ? button_1 : 0) | (pose(s).button_2 ? button_2 : 0); }},
    {0x2001, 0x2201, "CURRENT_SAFETY_SWITCH", "", 1, type_boolean, "always 0",
     [](const Source&, double* v) { *v = 0; }},
    {0x2002, 0x2202, "CURRENT_INKWELL_SWITCH", "", 1, type_boolean, "0 while the stylus is in the inkwell",
     [](const Source& s, double* v) { *v = pose(s).in_inkwell == 0; }},
    {0x2010, 0x2210, "CURRENT_ENCODER_VALUES", "counts", 6, type_long,
     "0 at joint angle 0; gimbal: 4096 counts per turn", read_encoders},
    {0x2011, 0, "CURRENT_PINCH_VALUE", "", 1, type_real, "always 0", [](const Source&, double* v) { *v = 0; }},
    {0x2012, 0, "LAST_PINCH_VALUE", "", 1, type_real, "always 0", [](const Source&, double* v) { *v = 0; }},
    {0x2050, 0x2250, "CURRENT_POSITION", "mm", 3, type_real, "probe; x right, y up, z to the user",
     [](const Source& s, double* v) { put(pose(s).position_m, 1e3, v); }},
    {0x2051, 0x2251, "CURRENT_VELOCITY", "mm/s", 3, type_real, "probe, over the last 8 ms",
     [](const Source& s, double* v) { put(pose(s).velocity_m_s, 1e3, v); }},
    {0x2052, 0x2252, "CURRENT_TRANSFORM", "mm", 16, type_real, "stylus, column-major; the last column is the position",
     read_transform},
    {0x2053, 0x2253, "CURRENT_ANGULAR_VELOCITY", "rad/s", 3, type_real, "stylus, smoothed over about 8 ms",
     [](const Source& s, double* v) { put(s.moment->angular_velocity_rad_per_s, 1.0, v); }},
    {0x2054, 0x2254, "CURRENT_JACOBIAN", "mm/rad", 36, type_real,
     "row-major; probe velocity from joints 1 to 3, otherwise 0", read_jacobian},
    {0x2100, 0x2300, "CURRENT_JOINT_ANGLES", "rad", 3, type_real, "positive: turret left, thigh up, shin up (absolute)",
     read_joints},
    {0x2150, 0x2350, "CURRENT_GIMBAL_ANGLES", "rad", 3, type_real, "positive: right, down, clockwise",
     [](const Source& s, double* v) { put(pose(s).gimbal_rad, 1.0, v); }},
    {0x2702, 0, "JOINT_ANGLE_REFERENCES", "rad", 3, type_real, "offsets of the joint angles, always 0",
     [](const Source&, double* v) { std::fill_n(v, 3, 0.0); }},

    {0x2500, 0, "VERSION", "", 1, type_string, "HDAPI version 3.4.0; needs no device", nullptr,
     [](const Source&) { return std::string("3.4.0"); }, nullptr, false},
    {0x2501, 0, "DEVICE_MODEL_TYPE", "", 1, type_string, "PHANTOM Omni", nullptr,
     [](const Source&) { return std::string("PHANTOM Omni"); }},
    {0x2502, 0, "DEVICE_DRIVER_VERSION", "", 1, type_string, "version of libinkwell", nullptr,
     [](const Source&) { return std::string(inkwell_version()); }},
    {0x2503, 0, "DEVICE_VENDOR", "", 1, type_string, "Inkwell, or Inkwell (simulation)", nullptr,
     [](const Source& s) { return "Inkwell" + simulation_mark(s); }},
    {0x2504, 0, "DEVICE_SERIAL_NUMBER", "", 1, type_string, "board serial number", nullptr,
     [](const Source& s) { return std::string(s.device->information().serial_number); }},
    {0x2505, 0, "DEVICE_FIRMWARE_VERSION", "", 1, type_string | type_real, "as a number: major and minor",
     [](const Source& s, double* v) { *v = std::atof(s.device->information().firmware_version); },
     [](const Source& s) { return std::string(s.device->information().firmware_version); }},

    {0x2550, 0, "MAX_WORKSPACE_DIMENSIONS", "mm", 6, type_real,
     "reach of the probe: minimum x, y, z, then maximum x, y, z",
     [](const Source& s, double* v) { put(facts(s).reach, v); }},
    {0x2551, 0, "USABLE_WORKSPACE_DIMENSIONS", "mm", 6, type_real, "box of the arm when the device was opened",
     [](const Source& s, double* v) { put(facts(s).box, v); }},
    {0x2552, 0, "TABLETOP_OFFSET", "mm", 1, type_real, "110",
     [](const Source&, double* v) { *v = tabletop_offset_mm; }},
    {0x2553, 0, "INPUT_DOF", "", 1, type_integer, "6", [](const Source&, double* v) { *v = input_axes; }},
    {0x2554, 0, "OUTPUT_DOF", "", 1, type_integer, "3", [](const Source&, double* v) { *v = output_axes; }},
    {0x2555, 0, "CALIBRATION_STYLE", "", 1, type_integer, "4, the inkwell",
     [](const Source&, double* v) { *v = calibration_style_inkwell; }},

    {0x2600, 0, "UPDATE_RATE", "Hz", 1, type_integer | type_real, "scheduler rate that was set",
     [](const Source& s, double* v) { *v = s.scheduler.rate_Hz(); }, nullptr, nullptr, false},
    {0x2601, 0, "INSTANTANEOUS_UPDATE_RATE", "Hz", 1, type_integer | type_real,
     "rate of the last tick in board time, at least 1",
     [](const Source& s, double* v) { *v = std::max(1.0, std::round(s.scheduler.measured_rate_Hz())); }, nullptr,
     nullptr, false},
    {0x2602, 0, "NOMINAL_MAX_STIFFNESS", "N/mm", 1, type_real, "0.5",
     [](const Source& s, double* v) { *v = 1e-3 * facts(s).stiffness_N_per_m; }},
    {0x2609, 0, "NOMINAL_MAX_DAMPING", "N s/mm", 1, type_real, "0.002",
     [](const Source& s, double* v) { *v = 1e-3 * facts(s).damping_Ns_per_m; }},
    {0x2603, 0, "NOMINAL_MAX_FORCE", "N", 1, type_real, "`force_limit_N` when the device was opened",
     [](const Source& s, double* v) { *v = facts(s).force_maximum_N; }},
    {0x2604, 0, "NOMINAL_MAX_CONTINUOUS_FORCE", "N", 1, type_real, "continuous force with the arm stretched out",
     [](const Source& s, double* v) { *v = facts(s).force_continuous_N; }},
    {0x2605, 0, "MOTOR_TEMPERATURE", "", 3, type_real, "motor heat, 0 to 1; warm from 0.85; read twice a second",
     [](const Source& s, double* v) {
       for (std::size_t i = 0; i < 3; ++i) v[i] = std::clamp(s.device->motor_heat(i), 0.0, 1.0);
     }},
    {0x2606, 0, "SOFTWARE_VELOCITY_LIMIT", "mm/s", 1, type_real, "default 1200",
     [](const Source& s, double* v) { *v = s.device->settings.velocity_limit_mm_per_s; }, nullptr,
     write_positive<&Settings::velocity_limit_mm_per_s>},
    {0x2607, 0, "SOFTWARE_FORCE_IMPULSE_LIMIT", "N/ms", 1, type_real, "default 4",
     [](const Source& s, double* v) { *v = s.device->settings.impulse_limit_N_per_ms; }, nullptr,
     write_positive<&Settings::impulse_limit_N_per_ms>},
    {0x2608, 0, "FORCE_RAMPING_RATE", "N/s", 1, type_real, "default 10",
     [](const Source& s, double* v) { *v = s.device->settings.ramping_rate_N_per_s; }, nullptr,
     write_positive<&Settings::ramping_rate_N_per_s>},
    {0x2620, 0, "NOMINAL_MAX_TORQUE_STIFFNESS", "", 1, type_real, "0", [](const Source&, double* v) { *v = 0; }},
    {0x2621, 0, "NOMINAL_MAX_TORQUE_DAMPING", "", 1, type_real, "0", [](const Source&, double* v) { *v = 0; }},
    {0x2622, 0, "NOMINAL_MAX_TORQUE_FORCE", "mNm", 1, type_real, "0", [](const Source&, double* v) { *v = 0; }},
    {0x2623, 0, "NOMINAL_MAX_TORQUE_CONTINUOUS_FORCE", "mNm", 1, type_real, "0",
     [](const Source&, double* v) { *v = 0; }},

    {0x2700, 0x2800, "CURRENT_FORCE", "N", 3, type_real, "force on the hand; in a frame 0 until it is set",
     [](const Source& s, double* v) { put(command(s).force_N.value_or(Vector{}), 1.0, v); }, nullptr,
     write_optional<&Command::force_N>},
    {0x2701, 0x2801, "CURRENT_TORQUE", "mNm", 3, type_real, "stored, no effect",
     [](const Source& s, double* v) { put(command(s).torque_mNm, 1.0, v); }, nullptr,
     write_vector<&Command::torque_mNm>},
    {0x2703, 0x2802, "CURRENT_JOINT_TORQUE", "mNm", 3, type_real, "converted to a force; overrides CURRENT_FORCE",
     [](const Source& s, double* v) { put(command(s).joint_torque_mNm.value_or(Vector{}), 1.0, v); }, nullptr,
     write_optional<&Command::joint_torque_mNm>},
    {0x2704, 0x2803, "CURRENT_GIMBAL_TORQUE", "mNm", 3, type_real, "stored, no effect",
     [](const Source& s, double* v) { put(command(s).gimbal_torque_mNm, 1.0, v); }, nullptr,
     write_vector<&Command::gimbal_torque_mNm>},
    {0x2750, 0x2850, "CURRENT_MOTOR_DAC_VALUES", "", 3, type_long | type_integer,
     "32767: torque at the motor's current limit; converted to a force",
     [](const Source& s,
        double* v) { std::copy_n(command(s).motor_values.value_or(std::array<double, 6>{}).begin(), 3, v); },
     nullptr, write_motor_values},
    {0x2900, 0, "USER_STATUS_LIGHT", "", 1, type_integer, "0 to 7; stored, no effect",
     [](const Source& s, double* v) { *v = s.device->settings.status_light; }, nullptr, write_status_light},
};
// clang-format on

}  // namespace

std::span<const Parameter> parameter_table() { return table; }

std::optional<FoundParameter> find_parameter(Enum value) {
  for (const auto& row : table) {
    if (row.value == value) return FoundParameter{&row, false};
    if (row.last == value && value != 0) return FoundParameter{&row, true};
  }
  return std::nullopt;
}

}  // namespace inkwell::dropins
