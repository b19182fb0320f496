// A device under test, and the time that passes for it: board time of a virtual board, which stands still while the
// host works, or the wall clock of a real one.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <device/control_client.hpp>
#include <device/device.hpp>
#include <experiment/recording.hpp>

namespace inkwell::experiment {

class Rig {
 public:
  /// `control` is null for a real device.
  Rig(device::Device& device, device::ControlClient* control) : device_(device), control_(control) {}

  /// Lets time pass, reads every pose and keeps the host's sign of life. Throws device::Error with cause and remedy
  /// when the device reports a fault.
  void pass(double time_s);
  /// Throws device::Error with `otherwise` if the condition does not come true in time.
  void wait_until(const std::function<bool(const protocol::PoseReport&)>& condition, double limit_s,
                  const std::string& otherwise);
  /// Sends a command and waits until it was carried out.
  void command(protocol::Command command) { wait_for_token(device_.send(command)); }
  void test_current(const protocol::TestPulse& pulse) {
    wait_for_token(device_.send(protocol::Command::test_current, pulse));
  }
  void select_signals(std::span<const protocol::Signal> signals) { wait_for_token(device_.select_signals(signals)); }

  const protocol::PoseReport& pose() const { return *pose_; }
  std::uint64_t poses_received() const { return poses_received_; }
  std::uint64_t poses_lost() const { return poses_lost_; }

 private:
  void pass_slice();
  void read_poses(std::chrono::milliseconds timeout);
  void wait_for_token(std::uint8_t token);

  device::Device& device_;
  device::ControlClient* control_;
  std::optional<protocol::PoseReport> pose_;
  std::uint64_t poses_received_ = 0;
  std::uint64_t poses_lost_ = 0;
};

/// Reads the scope in a thread of its own for as long as it lives.
class ScopeCapture {
 public:
  explicit ScopeCapture(device::Device& device);
  ~ScopeCapture();
  ScopeCapture(const ScopeCapture&) = delete;
  ScopeCapture& operator=(const ScopeCapture&) = delete;

  std::size_t size() const;
  /// The first `samples` samples, once they are there. Throws device::Error if they do not come, or if some are lost.
  ScopeRecording take(std::size_t samples);

 private:
  device::Device& device_;
  mutable std::mutex mutex_;
  ScopeRecording recording_;
  std::optional<std::string> failure_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace inkwell::experiment
