#include "boards/virtual/plant/truth.hpp"

#include <algorithm>

namespace inkwell::virtual_board {
namespace {

/// Value of one quantity.
double value_of(protocol::SimulatedQuantity quantity, const Truth& truth) {
  using enum protocol::SimulatedQuantity;
  switch (quantity) {
    case true_position_x_m: return truth.position_m[0];
    case true_position_y_m: return truth.position_m[1];
    case true_position_z_m: return truth.position_m[2];
    case true_velocity_x_m_s: return truth.velocity_m_s[0];
    case true_velocity_y_m_s: return truth.velocity_m_s[1];
    case true_velocity_z_m_s: return truth.velocity_m_s[2];
    case true_joint_1_rad: return truth.joints_rad[0];
    case true_joint_2_rad: return truth.joints_rad[1];
    case true_joint_3_rad: return truth.joints_rad[2];
    case true_joint_speed_1_rad_s: return truth.joint_speeds_rad_s[0];
    case true_joint_speed_2_rad_s: return truth.joint_speeds_rad_s[1];
    case true_joint_speed_3_rad_s: return truth.joint_speeds_rad_s[2];
    case true_current_1_A: return truth.current_A[0];
    case true_current_2_A: return truth.current_A[1];
    case true_current_3_A: return truth.current_A[2];
    case true_torque_1_Nm: return truth.torque_Nm[0];
    case true_torque_2_Nm: return truth.torque_Nm[1];
    case true_torque_3_Nm: return truth.torque_Nm[2];
    case hand_force_x_N: return truth.hand_force_N[0];
    case hand_force_y_N: return truth.hand_force_N[1];
    case hand_force_z_N: return truth.hand_force_N[2];
    case hand_target_x_m: return truth.hand_target_m[0];
    case hand_target_y_m: return truth.hand_target_m[1];
    case hand_target_z_m: return truth.hand_target_m[2];
    case true_supply_V: return truth.supply_V;
  }
  return 0;
}

}  // namespace

TracedValues traced_values(const Truth& truth) {
  TracedValues values;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = value_of(static_cast<protocol::SimulatedQuantity>(i), truth);
  return values;
}

void Trace::start() {
  rows_.clear();
  dropped_ = 0;
  running_ = true;
}

void Trace::record(std::uint64_t period, const Truth& truth) {
  if (!running_) return;
  if (rows_.size() == rows_maximum) {
    rows_.pop_front();
    ++dropped_;
  }
  rows_.push_back({period, truth.at, traced_values(truth)});
}

std::vector<Trace::Row> Trace::read(std::size_t maximum) {
  const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(std::min(maximum, rows_.size()));
  std::vector<Row> taken(rows_.begin(), end);
  rows_.erase(rows_.begin(), end);
  return taken;
}

}  // namespace inkwell::virtual_board
