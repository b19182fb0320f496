// Models of the user's hand and the inkwell. Each model is a spring and a damper between the probe and a moving point.
#pragma once

#include <optional>
#include <vector>

#include "boards/stm32f405/core/interfaces.hpp"
#include "boards/virtual/plant/arm_dynamics.hpp"

namespace inkwell::virtual_board {

/// Force on the probe: stiffness (target - probe) + damping (target velocity - probe velocity).
struct Coupling {
  double stiffness_N_per_m = 0.0;
  double damping_Ns_per_m = 0.0;
  Vector3 target_m = Vector3::Zero();
  Vector3 target_velocity_m_s = Vector3::Zero();

  Vector3 force_N(const Vector3& position_m, const Vector3& velocity_m_s) const {
    return stiffness_N_per_m * (target_m - position_m) + damping_Ns_per_m * (target_velocity_m_s - velocity_m_s);
  }
};

struct Waypoint {
  double after_s;  ///< since the call of follow(), increasing
  Vector3 target_m;
};

/// Model of the hand: an impedance with a fixed or moving target. The target follows minimum-jerk motion, a model of
/// human motion (Flash and Hogan 1985).
class Hand {
 public:
  static constexpr double stiffness_maximum_N_per_m = 5000.0;
  static constexpr double damping_maximum_Ns_per_m = 100.0;

  bool holds() const { return holds_; }
  void hold(const Vector3& target_m, double stiffness_N_per_m, double damping_Ns_per_m);
  void release();
  /// Moves the target along the waypoints. The motion starts at `now` at the present target position. A hand that does
  /// not hold the stylus first grips the stylus at `probe_m`.
  void follow(const std::vector<Waypoint>& waypoints, const Vector3& probe_m, Ticks now);

  double stiffness_N_per_m() const { return stiffness_N_per_m_; }
  double damping_Ns_per_m() const { return damping_Ns_per_m_; }
  bool is_moving(Ticks now) const { return holds_ && !path_.empty() && now < path_.back().at; }
  /// Returns the coupling to the present target. The coupling has no force if the hand does not hold the stylus.
  Coupling coupling(Ticks now) const;

 private:
  struct Node {
    Ticks at;
    Vector3 target_m;
  };
  bool holds_ = false;
  double stiffness_N_per_m_ = 300.0;
  double damping_Ns_per_m_ = 3.0;
  Vector3 target_m_ = Vector3::Zero();
  std::vector<Node> path_;           ///< the first node is the start
  mutable std::size_t segment_ = 0;  ///< result of the last look-up, since time never decreases
};

/// Model of the inkwell: socket, funnel, grip and switch. The grip retains the stylus.
class Inkwell {
 public:
  Inkwell(const Vector3& position_m, bool seated) : position_m_(position_m), guide_m_(position_m), seated_(seated) {}

  bool seated() const { return seated_; }
  const Vector3& position_m() const { return position_m_; }
  /// Seats a stylus in the funnel. Returns true if the stylus is seated.
  bool capture(const Vector3& probe_m);
  void eject() { seated_ = false; }
  /// Advances by one step. The funnel guides the stylus into the socket. A pull stronger than the socket's grip removes
  /// the stylus.
  void advance(double duration_s, const Vector3& probe_m);
  bool switch_closed(const Vector3& probe_m) const;
  Coupling coupling() const;

 private:
  Vector3 position_m_;
  Vector3 guide_m_;
  bool seated_;
};

}  // namespace inkwell::virtual_board
