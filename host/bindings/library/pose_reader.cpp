#include "host/bindings/library/pose_reader.hpp"

#include "host/client/kinematics/stylus.hpp"

namespace inkwell::library {
namespace {

/// Maps newer states to the states that existing programs know.
inkwell_state state_of(protocol::State state) {
  if (protocol::force_is_on(state)) return INKWELL_ACTIVE;
  // In these states the arm is temporarily unavailable.
  if (state == protocol::State::update || state == protocol::State::testing) return INKWELL_STARTING;
  return static_cast<inkwell_state>(state);
}

}  // namespace

inkwell_pose PoseReader::read(const device::Pose& report, const control::Arm& geometry) {
  inkwell_pose pose{};
  pose.time_s = device::board_time_s(report.time_periods);
  pose.sequence = static_cast<std::uint32_t>(report.sequence);  // wraps, as inkwell.h describes
  pose.state = state_of(report.state);
  pose.fault = static_cast<int>(report.fault);
  pose.limits = report.limits;
  std::array<float, 3> joint_rad{}, gimbal_rad{};
  std::array<double, 3> position_m{};
  for (std::size_t i = 0; i < 3; ++i) {
    pose.position_m[i] = position_m[i] = report.position_m[i];
    pose.joint_rad[i] = joint_rad[i] = report.joint_rad[i];
    pose.gimbal_rad[i] = gimbal_rad[i] = report.gimbal_rad[i];
    pose.force_N[i] = report.force_N[i];
  }
  if (!report.is_referenced)
    velocity_ = {};  // the position is unknown, so no velocity follows from it
  else
    velocity_.add(pose.time_s, position_m);
  const auto velocity_m_s = velocity_.velocity_m_s();
  for (std::size_t i = 0; i < 3; ++i) pose.velocity_m_s[i] = velocity_m_s[i];
  const glm::mat3 rotation = kinematics::stylus_rotation(joint_rad, gimbal_rad, geometry);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) pose.rotation[3 * row + column] = rotation[column][row];
  motion_ = motion_fit_.next(report, pose.time_s, rotation, geometry);
  pose.force_sources = report.force_sources;
  pose.button_1 = is_closed(report.switches, protocol::Switch::button_1);
  pose.button_2 = is_closed(report.switches, protocol::Switch::button_2);
  pose.in_inkwell = is_closed(report.switches, protocol::Switch::inkwell);
  pose.supply_V = report.supply_dV / 10.0;
  return pose;
}

std::optional<ReadPose> PoseReader::read_newest(device::Device& device, std::chrono::milliseconds timeout,
                                                const control::Arm& geometry,
                                                const std::function<void(const device::Pose&)>& on_report) {
  std::optional<ReadPose> newest;
  while (const auto report = device.read_pose(newest ? std::chrono::milliseconds(0) : timeout)) {
    if (on_report) on_report(*report);
    newest = ReadPose{read(*report, geometry), report->is_referenced != 0, motion_};
  }
  return newest;
}

}  // namespace inkwell::library
