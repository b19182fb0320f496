// Runs a device in board time, so that the load of the host's computer has no effect. A virtual board stops while the
// host computes.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "host/client/device/control_client.hpp"
#include "host/client/device/device.hpp"

namespace inkwell::experiment {

class PacedDevice {
 public:
  /// `control` is null for a real device.
  PacedDevice(device::Device& device, device::ControlClient* control) : device_(device), control_(control) {}

  /// Waits, reads every pose and sends heartbeats. Throws device::Error if the device reports a fault or becomes
  /// silent.
  void pass(double time_s);
  /// Waits until the condition is true. Throws device::Error with the text `otherwise` if the condition is false after
  /// `limit_s`.
  void wait_until(const std::function<bool()>& condition, double limit_s, const std::string& otherwise);
  void wait_for_pose(const std::function<bool(const device::Pose&)>& condition, double limit_s,
                     const std::string& otherwise);
  /// Sends a command and waits until the device has executed it.
  void command(protocol::Command command) { wait_for_token(device_.send(command)); }
  void test_current(const protocol::TestPulse& pulse) {
    wait_for_token(device_.send(protocol::Command::test_current, pulse));
  }
  void select_signals(std::span<const protocol::Signal> signals) { wait_for_token(device_.select_signals(signals)); }

  device::Device& device() { return device_; }
  const device::Pose& pose() const { return *pose_; }
  std::uint64_t poses_received() const { return poses_received_; }
  std::uint64_t poses_lost() const { return poses_lost_; }

 private:
  void pass_slice();
  void read_poses(std::chrono::milliseconds timeout);
  void wait_for_token(std::uint8_t token);

  device::Device& device_;
  device::ControlClient* control_;
  std::chrono::nanoseconds passed_{};  ///< board time since the start
  unsigned slices_ = 0;
  std::optional<device::Pose> pose_;
  std::uint64_t poses_received_ = 0;
  std::uint64_t poses_lost_ = 0;
  int silent_reads_ = 0;  ///< since the last pose
};

}  // namespace inkwell::experiment
