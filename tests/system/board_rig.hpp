// A virtual board with the flashed firmware, and a host on its USB. Board time advances in `run` and during requests to
// the device. Equal calls produce equal runs, independent of the machine's speed.
#pragma once

#include <chrono>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "host/client/device/control_client.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"

namespace inkwell::tests {

class BoardRig {
 public:
  /// Starts the board with the stylus in the inkwell, and opens the device.
  explicit BoardRig(device::SimulationMode mode = device::SimulationMode::fast, std::uint64_t seed = 1,
                    device::CyclePricing pricing = device::CyclePricing::likely);
  /// Uses another image, build/board/`image`.
  explicit BoardRig(const std::string& image);
  /// Uses the options of stepped_board(). The board stops when the firmware first breaks a rule of the chip.
  explicit BoardRig(device::VirtualBoardOptions options);

  /// Advances board time in slices of 10 ms, collects all poses, and sends the host's signs of life.
  void run(double time_s);
  /// Advances board time without signs of life of the host.
  void run_silent(double time_s);
  void set(std::initializer_list<device::ParameterChange> changes);
  /// Sends a command, which the device receives when board time advances.
  void command(protocol::Command command);
  /// Sends a program's force for the newest pose and advances board time by one millisecond. The board refuses a force
  /// for an old pose.
  void push(const device::ForceRequest& force);
  /// Waits for the device for at most one second of board time, and opens the device.
  void connect();
  /// Runs until the newest pose satisfies the condition; fails the test after `limit_s` of board time.
  void run_until(const std::function<bool(const device::Pose&)>& condition, double limit_s = 3.0);

  /// Lets the hand move the stylus out of the inkwell and to a point of the workspace.
  void take_to(device::Vector3 target_m, double duration_s = 0.6);
  /// Waits for the reference, then switches the force on.
  void make_active();

  const device::Pose& pose() const { return poses_.back(); }
  const std::vector<device::Pose>& poses() const { return poses_; }
  double board_time_s() { return control.status().board_time_s; }

  device::VirtualBoard board;
  device::ControlClient control;
  std::unique_ptr<device::Device> device;

 private:
  void pass_slice();
  std::uint64_t seed_;  ///< seed of the board and of the host's random numbers
  double since_sign_of_life_s_ = 0;
  std::vector<device::Pose> poses_;
};

/// Resets the board while its injected faults remain active. Returns the results of the self-test at start-up.
protocol::SelfTestReport self_test_after_reset(BoardRig& rig);

/// Returns the largest true current of the three motors.
double largest_current_A(device::ControlClient& control);

/// The center of the default arm's box.
inline constexpr device::Vector3 free_point_m{0.0, 0.0, -0.03};
/// Returns free_point_m plus this offset.
constexpr device::Vector3 offset_from_free_point(double x_m, double y_m, double z_m) {
  return {free_point_m[0] + x_m, free_point_m[1] + y_m, free_point_m[2] + z_m};
}

}  // namespace inkwell::tests
