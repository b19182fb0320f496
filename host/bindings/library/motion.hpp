// Quantities that the library adds to a pose for inkwell_get_state().
#pragma once

#include <array>
#include <cstdint>

#include <glm/mat3x3.hpp>

#include "firmware/control/signal_path/kinematics.hpp"
#include "host/client/device/device.hpp"
#include "host/client/kinematics/velocity.hpp"

namespace inkwell::library {

struct Motion {
  std::array<double, 3> joint_speed_rad_per_s{};
  std::array<double, 3> angular_velocity_rad_per_s{};  ///< of the stylus, in workspace axes
  std::array<double, 3> joint_torque_Nm{};             ///< that the force on the hand requires
  std::array<double, 4> quaternion{0, 0, 0, 1};        ///< of the stylus: x, y, z, w
  std::int64_t received_ns = 0;                        ///< host clock CLOCK_REALTIME
  std::int64_t received_monotonic_ns = 0;              ///< host clock CLOCK_MONOTONIC
};

/// Computes the motion of successive poses. Use one object for each arm, in a single thread.
class MotionFit {
 public:
  /// Without referenced encoders, speeds and torques are 0.
  Motion next(const device::Pose& report, double time_s, const glm::mat3& rotation, const control::Arm& geometry);

 private:
  kinematics::VelocityFit joints_;
  std::array<kinematics::VelocityFit, 3> axes_;  ///< one for each axis of the stylus
};

}  // namespace inkwell::library
