// Table of quantities that exist only in a simulation: X(name, unit, help).
//
// A virtual board records all simulated quantities in every control period, in table order. Recordings use the names as
// column names.
#pragma once

// To add a quantity, add a row here and a case to value_of() in boards/virtual/plant/truth.cpp. The compiler reports a
// missing case. A new value needs a member of Truth (plant/truth.hpp). Recordings, plots and the control socket use
// this table.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace inkwell::protocol {

// clang-format off
#define INKWELL_SIMULATED_QUANTITIES(X)                                                              \
  X(true_position_x_m, "m", "Position of the simulated probe, x.")                              \
  X(true_position_y_m, "m", "Position of the simulated probe, y.")                              \
  X(true_position_z_m, "m", "Position of the simulated probe, z.")                              \
  X(true_velocity_x_m_s, "m/s", "Velocity of the simulated probe, x.")                               \
  X(true_velocity_y_m_s, "m/s", "Velocity of the simulated probe, y.")                               \
  X(true_velocity_z_m_s, "m/s", "Velocity of the simulated probe, z.")                               \
  X(true_joint_1_rad, "rad", "Angle of joint 1 (waist) of the simulated arm.")                             \
  X(true_joint_2_rad, "rad", "Angle of joint 2 (shoulder) of the simulated arm.")                          \
  X(true_joint_3_rad, "rad", "Angle of joint 3 (elbow) of the simulated arm.")                             \
  X(true_joint_speed_1_rad_s, "rad/s", "Speed of joint 1 of the simulated arm.")                     \
  X(true_joint_speed_2_rad_s, "rad/s", "Speed of joint 2 of the simulated arm.")                     \
  X(true_joint_speed_3_rad_s, "rad/s", "Speed of joint 3 of the simulated arm.")                     \
  X(true_current_1_A, "A", "Current in the simulated motor 1, including ripple.")                     \
  X(true_current_2_A, "A", "Current in the simulated motor 2, including ripple.")                     \
  X(true_current_3_A, "A", "Current in the simulated motor 3, including ripple.")                     \
  X(true_torque_1_Nm, "Nm", "Torque of the simulated motor 1 at joint 1.")                           \
  X(true_torque_2_Nm, "Nm", "Torque of the simulated motor 2 at joint 2.")                           \
  X(true_torque_3_Nm, "Nm", "Torque of the simulated motor 3 at joint 3.")                           \
  X(hand_force_x_N, "N", "Force of the simulated hand on the probe, x.")                             \
  X(hand_force_y_N, "N", "Force of the simulated hand on the probe, y.")                             \
  X(hand_force_z_N, "N", "Force of the simulated hand on the probe, z.")                             \
  X(hand_target_x_m, "m", "Target position of the simulated hand, x. The target equals the probe position while the hand does not hold the stylus.") \
  X(hand_target_y_m, "m", "Target position of the simulated hand, y. The target equals the probe position while the hand does not hold the stylus.") \
  X(hand_target_z_m, "m", "Target position of the simulated hand, z. The target equals the probe position while the hand does not hold the stylus.") \
  X(true_supply_V, "V", "Supply voltage of the simulated bridges.")
// clang-format on

/// The value of an enumerator is the index of its row.
enum class SimulatedQuantity : std::uint8_t {
#define X(name, ...) name,
  INKWELL_SIMULATED_QUANTITIES(X)
#undef X
};

struct SimulatedQuantityInfo {
  std::string_view name;
  std::string_view unit;
  std::string_view help;
};

inline constexpr auto simulated_quantity_table = std::to_array<SimulatedQuantityInfo>({
#define X(name, unit, help) {#name, unit, help},
    INKWELL_SIMULATED_QUANTITIES(X)
#undef X
});

inline constexpr std::size_t simulated_quantity_count = simulated_quantity_table.size();

constexpr const SimulatedQuantityInfo& info(SimulatedQuantity quantity) {
  return simulated_quantity_table[static_cast<std::size_t>(quantity)];
}

constexpr std::optional<SimulatedQuantity> find_simulated_quantity(std::string_view name) {
  for (std::size_t i = 0; i < simulated_quantity_count; ++i)
    if (simulated_quantity_table[i].name == name) return static_cast<SimulatedQuantity>(i);
  return std::nullopt;
}

}  // namespace inkwell::protocol
