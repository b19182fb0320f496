#include <plant/truth.hpp>

#include <algorithm>

namespace inkwell::virtual_board {

TracedValues traced_values(const Truth& t) {
  TracedValues values;
  std::size_t next = 0;
  for (const Vector3* v : {&t.position_m, &t.velocity_m_s, &t.joints_rad, &t.joint_speeds_rad_s, &t.current_A,
                           &t.torque_Nm, &t.hand_force_N, &t.hand_target_m})
    for (int axis = 0; axis < 3; ++axis) values[next++] = (*v)[axis];
  values[next] = t.supply_V;
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
