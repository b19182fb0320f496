#include "boards/virtual/plant/hand.hpp"

#include <algorithm>
#include <cmath>

namespace inkwell::virtual_board {

void Hand::hold(const Vector3& target_m, double stiffness_N_per_m, double damping_Ns_per_m) {
  holds_ = true;
  target_m_ = target_m;
  stiffness_N_per_m_ = stiffness_N_per_m;
  damping_Ns_per_m_ = damping_Ns_per_m;
  path_.clear();
}

void Hand::release() {
  holds_ = false;
  path_.clear();
}

void Hand::follow(const std::vector<Waypoint>& waypoints, const Vector3& probe_m, Ticks now) {
  const Vector3 start_m = holds_ ? coupling(now).target_m : probe_m;
  holds_ = true;
  target_m_ = start_m;
  segment_ = 0;
  path_.clear();
  path_.push_back({now, start_m});
  for (const Waypoint& point : waypoints) path_.push_back({now + ticks(point.after_s), point.target_m});
}

Coupling Hand::coupling(Ticks now) const {
  if (!holds_) return {};
  Coupling c{stiffness_N_per_m_, damping_Ns_per_m_, target_m_, Vector3::Zero()};
  if (path_.empty()) return c;
  while (segment_ + 1 < path_.size() && path_[segment_ + 1].at <= now) ++segment_;
  const Node& from = path_[segment_];
  c.target_m = from.target_m;
  if (segment_ + 1 == path_.size()) return c;
  const Node& to = path_[segment_ + 1];
  const double duration_s = seconds(to.at - from.at);
  const double s = seconds(now - from.at) / duration_s;
  const Vector3 way_m = to.target_m - from.target_m;
  c.target_m += way_m * (s * s * s * (10.0 + s * (-15.0 + 6.0 * s)));
  c.target_velocity_m_s = way_m * (30.0 * s * s * (1.0 - s) * (1.0 - s) / duration_s);
  return c;
}

namespace {
constexpr double socket_stiffness_N_per_m = 50e3;  // the arm's weight deflects it by less than one encoder count
constexpr double socket_damping_Ns_per_m = 60.0;
constexpr double socket_grip_N = 6.0;
constexpr double funnel_radius_m = 0.003;
constexpr double funnel_time_constant_s = 0.02;
constexpr double switch_travel_m = 0.0005;
}  // namespace

bool Inkwell::capture(const Vector3& probe_m) {
  if (!seated_ && (probe_m - position_m_).norm() < funnel_radius_m) {
    seated_ = true;
    guide_m_ = probe_m;
  }
  return seated_;
}

void Inkwell::advance(double duration_s, const Vector3& probe_m) {
  if (!seated_) return;
  guide_m_ += (position_m_ - guide_m_) * (duration_s / funnel_time_constant_s);
  if ((guide_m_ - probe_m).norm() * socket_stiffness_N_per_m > socket_grip_N) seated_ = false;
}

bool Inkwell::switch_closed(const Vector3& probe_m) const {
  return seated_ && (probe_m - position_m_).norm() < switch_travel_m;
}

Coupling Inkwell::coupling() const {
  if (!seated_) return {};
  return {socket_stiffness_N_per_m, socket_damping_Ns_per_m, guide_m_, Vector3::Zero()};
}

}  // namespace inkwell::virtual_board
