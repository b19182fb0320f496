#include "host/bindings/library/motion.hpp"

#include <ctime>

#include <glm/gtc/quaternion.hpp>

#include "firmware/control/signal_path/kinematics.hpp"

namespace inkwell::library {
namespace {

std::int64_t now_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::array<double, 4> quaternion_of(const glm::mat3& rotation) {
  const glm::quat quaternion = glm::quat_cast(rotation);
  const float sign = quaternion.w < 0.0f ? -1.0f : 1.0f;
  return {sign * quaternion.x, sign * quaternion.y, sign * quaternion.z, sign * quaternion.w};
}

}  // namespace

Motion MotionFit::next(const device::Pose& report, double time_s, const glm::mat3& rotation,
                       const control::Arm& geometry) {
  Motion motion;
  motion.received_ns = now_ns(CLOCK_REALTIME);
  motion.received_monotonic_ns = now_ns(CLOCK_MONOTONIC);
  motion.quaternion = quaternion_of(rotation);
  if (!report.is_referenced) {
    *this = {};  // the joint angles are unknown, so no speed follows from them
    return motion;
  }
  joints_.add(time_s, {report.joint_rad[0], report.joint_rad[1], report.joint_rad[2]});
  motion.joint_speed_rad_per_s = joints_.velocity_m_s();
  // An axis a changes by w x a, and the sum of a x (w x a) over three orthogonal unit axes is 2 w.
  for (int i = 0; i < 3; ++i) {
    const std::array<double, 3> axis{rotation[i].x, rotation[i].y, rotation[i].z};
    auto& fit = axes_[static_cast<std::size_t>(i)];
    fit.add(time_s, axis);
    const auto change = fit.velocity_m_s();
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t next = (j + 1) % 3, last = (j + 2) % 3;
      motion.angular_velocity_rad_per_s[j] += 0.5 * (axis[next] * change[last] - axis[last] * change[next]);
    }
  }
  const control::Triple joint_rad{report.joint_rad[0], report.joint_rad[1], report.joint_rad[2]};
  const auto torque_Nm = control::joint_torques(control::forward_kinematics(joint_rad, geometry).jacobian,
                                                {report.force_N[0], report.force_N[1], report.force_N[2]});
  for (std::size_t i = 0; i < 3; ++i) motion.joint_torque_Nm[i] = torque_Nm[i];
  return motion;
}

}  // namespace inkwell::library
