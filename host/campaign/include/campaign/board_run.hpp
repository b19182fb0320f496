// A virtual board of its own with an arm, a hand and a host that bears whatever becomes of the device.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <device/control_client.hpp>
#include <device/device.hpp>
#include <device/virtual_board.hpp>

namespace inkwell::campaign {

class BoardRun {
 public:
  /// Board time stands still. Throws device::Error if the board does not start.
  explicit BoardRun(const device::VirtualBoardOptions& options);

  /// Waits until the board shows its device and opens it; false if it does not in that time.
  bool connect(double limit_s);
  /// The same for a board that has started anew, until it had time to tell why.
  bool connect_after_restart();
  bool connected() const { return device_ != nullptr; }
  device::Device& device() { return *device_; }
  void set(std::initializer_list<device::ParameterChange> changes);
  /// Lets go of the device without a word, as a program does that is killed, and waits until the board's USB knows it.
  void drop_device();
  /// Called with every pose that is read from now on.
  void watch_poses(std::function<void(const device::Pose&)> watch) { watch_ = std::move(watch); }

  /// Lets board time pass, with the host's signs of life or without, and reads every pose. A device that is gone is
  /// let go of.
  void run(double time_s, bool gives_sign_of_life = true);
  /// The same to the instant, without a pose in between.
  void run_exactly(double time_s) { pass(time_s); }
  /// False if the condition does not come true in time.
  bool wait_for(const std::function<bool(const device::Pose&)>& condition, double limit_s);
  bool wait_for(protocol::State state, double limit_s);
  void command(protocol::Command command);

  /// The newest; none before the first, and after a connection was lost.
  const std::optional<device::Pose>& pose() const { return pose_; }
  bool is(protocol::State state) const { return pose_ && pose_->state == state; }
  bool force_is_on() const { return pose_ && protocol::force_is_on(pose_->state); }
  bool is_locked_up();
  /// How often the chip was reset since the power came, also by its watchdog.
  unsigned resets();
  void reset();
  /// Asks the firmware to start the chip's boot loader.
  void ask_for_boot_loader();
  bool is_in_boot_loader() const;
  /// Has the boot loader start the firmware; false if it does not do so.
  bool start_from_boot_loader();
  device::ControlClient& control() { return control_; }
  device::Vector3 true_position_m();

 private:
  void pass(double time_s);
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
