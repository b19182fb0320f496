// Table of the signals that the scope can stream in every control period: X(id, name, unit, wire, help).
//
// Recordings use the names as column names. Most signals are transmitted as floats. Signals that change in every period
// and have a source with few bits are transmitted as scaled 16-bit integers.
//
// The signals of the image's force law follow the last row (docs/force-laws.md).
#pragma once

// To add a signal:
// (1) Append a row with the next id. Signals of motors 1 to 3 or of x, y and z need matching names, units and wire
//     types. EachAxis compares the rows at compile time.
// (2) Write the value in Controller::write_signals() (firmware/control/controller.cpp).
// (3) To record the signal by default, add the signal to standard_signals() in host/client/recording/signals.cpp.
//
// Each signal needs about 800 bytes of RAM in the black box. The linker reports an overflow. `inkwell signals`, the
// scope, recordings and plots use this table.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "protocol/added_rows.hpp"
#include "protocol/each_axis.hpp"

namespace inkwell::protocol {

/// Encoding of a signal value in a scope frame.
enum class SignalWire : std::uint8_t {
  float32,        ///< 4 bytes, IEEE 754, little-endian
  current_int16,  ///< 2 bytes, in steps of `current_step_A`
  duty_int16,     ///< 2 bytes, in steps of `duty_step`
};

inline constexpr float current_step_A = 0.0002f;     ///< range +-6.5 A, finer than the ADC's 2 mA
inline constexpr float duty_step = 1.0f / 32767.0f;  ///< range +-1, finer than the timer's 1/1400

// clang-format off
#define INKWELL_SIGNALS(X)                                                                                     \
  X(0, encoder_1_counts, "counts", float32, "Count of encoder 1 relative to the inkwell, extended beyond the range of the timer.")       \
  X(1, encoder_2_counts, "counts", float32, "Count of encoder 2 relative to the inkwell.")                                    \
  X(2, encoder_3_counts, "counts", float32, "Count of encoder 3 relative to the inkwell.")                                    \
  X(3, joint_1_rad, "rad", float32, "Angle of joint 1, the waist.")                                                     \
  X(4, joint_2_rad, "rad", float32, "Angle of joint 2, the shoulder.")                                                  \
  X(5, joint_3_rad, "rad", float32, "Angle of joint 3, the elbow (absolute on a parallelogram arm).")                   \
  X(6, position_x_m, "m", float32, "Probe, x.")                                                                \
  X(7, position_y_m, "m", float32, "Probe, y.")                                                                \
  X(8, position_z_m, "m", float32, "Probe, z.")                                                                \
  X(9, velocity_x_m_s, "m/s", float32, "Probe velocity, x, estimated with an adaptive window.")                   \
  X(10, velocity_y_m_s, "m/s", float32, "Probe velocity, y.")                                           \
  X(11, velocity_z_m_s, "m/s", float32, "Probe velocity, z.")                                           \
  X(12, penetration_x_m, "m", float32, "Proxy minus probe, x. The vector points out of the wall.")                        \
  X(13, penetration_y_m, "m", float32, "Proxy minus probe, y.")                                                \
  X(14, penetration_z_m, "m", float32, "Proxy minus probe, z.")                                                \
  X(15, force_x_N, "N", float32, "Requested force on the hand, x. The signal `limits` shows further reductions.")                          \
  X(16, force_y_N, "N", float32, "Requested force on the hand, y.")                          \
  X(17, force_z_N, "N", float32, "Requested force on the hand, z.")                          \
  X(18, force_N, "N", float32, "Magnitude of the requested force.")                                                      \
  X(19, torque_1_Nm, "Nm", float32, "Torque at joint 1 (the paper's T1z).")                                    \
  X(20, torque_2_Nm, "Nm", float32, "Torque at joint 2 (the paper's T2x).")                                    \
  X(21, torque_3_Nm, "Nm", float32, "Torque at joint 3 (the paper's T3x).")                                    \
  X(22, current_reference_1_A, "A", float32, "Current reference of motor 1.")                                      \
  X(23, current_reference_2_A, "A", float32, "Current reference of motor 2.")                                      \
  X(24, current_reference_3_A, "A", float32, "Current reference of motor 3.")                                      \
  X(25, current_1_A, "A", current_int16, "Measured current of motor 1.")                                       \
  X(26, current_2_A, "A", current_int16, "Measured current of motor 2.")                                       \
  X(27, current_3_A, "A", current_int16, "Measured current of motor 3.")                                       \
  X(28, duty_1, "", duty_int16, "Duty cycle of bridge 1, -1 to 1.")                                    \
  X(29, duty_2, "", duty_int16, "Duty cycle of bridge 2, -1 to 1.")                                    \
  X(30, duty_3, "", duty_int16, "Duty cycle of bridge 3, -1 to 1.")                                    \
  X(31, gimbal_1_rad, "rad", float32, "Yaw of the gimbal. One of the three gimbal angles is measured in each control period.")                                                    \
  X(32, gimbal_2_rad, "rad", float32, "Pitch of the gimbal.")                                                  \
  X(33, gimbal_3_rad, "rad", float32, "Roll of the gimbal.")                                                   \
  X(34, joint_speed_1_rad_s, "rad/s", float32, "Speed of joint 1, estimated with an adaptive window.")                   \
  X(35, joint_speed_2_rad_s, "rad/s", float32, "Speed of joint 2, estimated with an adaptive window.")                   \
  X(36, joint_speed_3_rad_s, "rad/s", float32, "Speed of joint 3, estimated with an adaptive window.")                   \
  X(37, supply_V, "V", float32, "Supply voltage of the bridges, filtered.")                                            \
  X(38, servo_cycles, "cycles", float32, "Total CPU cycles of the previous control interrupt.") \
  X(39, stage_sample_cycles, "cycles", float32, "Cycles of stage 1: neutral duty, encoders, currents, gimbal.") \
  X(40, stage_pose_cycles, "cycles", float32, "Cycles of stage 2: joints, velocities, position, Jacobian.")    \
  X(41, stage_contact_cycles, "cycles", float32, "Cycles of stage 3: proxy, penetration, force.")              \
  X(42, stage_torque_cycles, "cycles", float32, "Cycles of stage 4: torques and current references.")          \
  X(43, stage_current_cycles, "cycles", float32, "Cycles of stage 5: current loops, duty, bridges.")           \
  X(44, stage_report_cycles, "cycles", float32, "Cycles of stage 6: supervisor, pose and scope records.")       \
  X(45, motor_heat_1, "", float32, "Winding heat of motor 1 above room temperature, relative to the heat at its continuous current.") \
  X(46, motor_heat_2, "", float32, "Winding heat of motor 2.")                                               \
  X(47, motor_heat_3, "", float32, "Winding heat of motor 3.")                                               \
  X(48, program_force_x_N, "N", float32, "Force of a program on the PC, interpolated by the board, x.") \
  X(49, program_force_y_N, "N", float32, "Force of a program on the PC, y.")                                   \
  X(50, program_force_z_N, "N", float32, "Force of a program on the PC, z.")                                   \
  X(51, force_sources, "", float32, "Sum of the active force sources: 1 walls, 2 shapes, 4 program.")       \
  X(52, limits, "", float32, "Sum of the active limits: 1 force, 2 current, 4 change, 8 energy, 16 heat, 32 speed.")
// clang-format on

/// Index of a signal in the table. The index is also the id in the protocol. Values after the last enumerator are
/// signals of the force law.
enum class Signal : std::uint8_t {
#define X(id, name, ...) name = id,
  INKWELL_SIGNALS(X)
#undef X
};

struct SignalInfo {
  std::uint8_t id;
  std::string_view name;
  std::string_view unit;
  SignalWire wire;
  std::string_view help;
};

inline constexpr auto signal_table = std::to_array<SignalInfo>({
#define X(id, name, unit, wire, help) {id, #name, unit, SignalWire::wire, help},
    INKWELL_SIGNALS(X)
#undef X
});

inline constexpr std::size_t signal_count = signal_table.size();

inline constexpr std::size_t force_law_signals_maximum = 8;
static_assert(signal_count + force_law_signals_maximum <= 256, "a signal's id has eight bits");

/// Returns the table, followed by the signals of a known force law.
inline KnownRows<SignalInfo, signal_count> known_signals() { return KnownRows(signal_table); }

constexpr const SignalInfo& info(Signal signal) {
  const auto place = static_cast<std::size_t>(signal);
  return place < signal_count ? signal_table[place] : known_signals()[place];
}
constexpr std::size_t row_count(Signal) { return signal_count; }
constexpr bool alike(const SignalInfo& a, const SignalInfo& b) { return a.unit == b.unit && a.wire == b.wire; }

/// Returns the signal of motor, joint or axis `axis` (0, 1 or 2). `rows` is the signal with index 0.
constexpr Signal of_axis(EachAxis<Signal> rows, std::size_t axis) { return rows[axis]; }
/// Returns the signal of motor, joint or axis `number` (1, 2 or 3, as in the row names).
constexpr Signal of_number(EachAxis<Signal> rows, int number) { return rows[static_cast<std::size_t>(number) - 1]; }

/// Values of all signals in one control period in table order, followed by the signals of the force law.
struct SignalValues {
  std::array<float, signal_count + force_law_signals_maximum> values;

  constexpr float& operator[](Signal signal) { return values[static_cast<std::size_t>(signal)]; }
  constexpr float operator[](Signal signal) const { return values[static_cast<std::size_t>(signal)]; }
};

constexpr std::size_t wire_size(SignalWire wire) { return wire == SignalWire::float32 ? 4 : 2; }

inline std::optional<Signal> find_signal(std::string_view name) {
  for (const auto& row : known_signals())
    if (row.name == name) return static_cast<Signal>(row.id);
  return std::nullopt;
}

namespace detail {
constexpr bool id_is_place(std::size_t id, std::string_view name) {
  return id < signal_count && signal_table[id].name == name;
}
}  // namespace detail
#define X(id, name, unit, wire, help)                                                              \
  static_assert(detail::id_is_place(id, #name),                                                    \
                #name ": the id must be the row index; append a new signal with the next id");     \
  static_assert(detail::neighbors_are_alike(signal_table, static_cast<std::size_t>(Signal::name)), \
                #name ": the rows 1 to 3, or x to z, must all exist and agree in unit and wire");
INKWELL_SIGNALS(X)
#undef X

}  // namespace inkwell::protocol
