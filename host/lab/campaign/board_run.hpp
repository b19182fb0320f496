// Runs a virtual board with an arm, a hand and a host for one case.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "host/client/device/control_client.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"

namespace inkwell::campaign {

class BoardRun {
 public:
  /// Board time is initially stopped. Throws device::Error if the board does not start.
  explicit BoardRun(const device::VirtualBoardOptions& options);

  /// Waits for the device and opens it. Returns false if the device does not appear within the limit.
  bool connect(double limit_s);
  /// Connects to a restarted board and waits until the board can report the cause of the restart.
  bool connect_after_restart();
  bool connected() const { return device_ != nullptr; }
  device::Device& device() { return *device_; }
  void set(std::initializer_list<device::ParameterChange> changes);
  /// Closes the device and waits until the board detects the disconnection.
  void drop_device();
  /// Registers a callback for each pose.
  void watch_poses(std::function<void(const device::Pose&)> watch) { watch_ = std::move(watch); }

  /// Advances board time and reads every pose. Closes the device after a disconnection.
  void run(double time_s, bool sends_heartbeats = true);
  /// Advances board time by exactly `time_s` and reads no poses.
  void run_exactly(double time_s) { pass(time_s); }
  /// Returns false if the condition does not become true in time.
  bool wait_for(const std::function<bool(const device::Pose&)>& condition, double limit_s);
  bool wait_for(protocol::State state, double limit_s);
  void command(protocol::Command command);
  /// Claims the arm. Does nothing without a device.
  void place(const device::Shapes& shapes);
  void send(const device::LocalModel& model, const device::ForceRequest& force);

  /// The newest pose; std::nullopt before the first pose and after a disconnection.
  const std::optional<device::Pose>& pose() const { return pose_; }
  bool is(protocol::State state) const { return pose_ && pose_->state == state; }
  bool force_is_on() const { return pose_ && protocol::force_is_on(pose_->state); }
  bool is_locked_up();
  /// Number of chip resets since power-on, including watchdog resets.
  unsigned resets();
  void reset();
  void request_boot_loader();
  bool is_in_boot_loader() const;
  /// Commands the boot loader to start the firmware. Returns false on failure.
  bool start_from_boot_loader();
  device::ControlClient& control() { return control_; }
  device::Vector3 true_position_m();

 private:
  void pass(double time_s);
  void use_device(const std::function<void(device::Device&)>& use);
  void read_poses();
  void let_go_of_device();
  std::vector<device::Endpoint> boot_loaders() const;

  device::VirtualBoard board_;
  device::ControlClient control_;
  std::unique_ptr<device::Device> device_;
  std::optional<device::Pose> pose_;
  std::function<void(const device::Pose&)> watch_;
  unsigned slices_ = 0;
};

}  // namespace inkwell::campaign
