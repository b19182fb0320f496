// A virtual board with the firmware that would be flashed, and a host on its USB. Board time passes only inside `run`
// and while the device answers a request, so that a slow test machine changes nothing: the same calls give the same
// run.
#pragma once

#include <chrono>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include <device/control_client.hpp>
#include <device/device.hpp>
#include <device/virtual_board.hpp>

namespace inkwell::tests {

class BoardRig {
 public:
  /// Starts the board, docked in its inkwell, and opens the device.
  explicit BoardRig(device::SimulationMode mode = device::SimulationMode::fast, std::uint64_t seed = 1,
                    device::CyclePricing pricing = device::CyclePricing::likely);
  /// With another image, build/board/`image`.
  explicit BoardRig(const std::string& image);
  /// Of stepped_board(); the first broken rule of the chip ends the board.
  explicit BoardRig(device::VirtualBoardOptions options);

  /// Lets board time pass in slices of 10 ms, collects every pose report, keeps the host's sign of life.
  void run(double time_s);
  /// The same without the sign of life.
  void run_silent(double time_s);
  void set(std::initializer_list<device::ParameterChange> changes);
  /// Sends a command; the device gets it when board time passes next.
  void command(protocol::Command command);
  /// Sends a program's force for the newest pose and lets a millisecond pass. The board refuses a force that answers an
  /// old pose.
  void push(const device::ForceRequest& force);
  /// Waits until the board shows a device, for a second of board time at most, and opens it.
  void connect();
  /// Runs until the newest pose fulfils the condition; fails the test after `limit_s` of board time.
  void run_until(const std::function<bool(const device::Pose&)>& condition, double limit_s = 3.0);

  /// Takes the stylus out of the inkwell by the hand and brings it to a point of the workspace.
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
  std::uint64_t seed_;  ///< of the board, and of the numbers that the host draws
  double since_sign_of_life_s_ = 0;
  std::vector<device::Pose> poses_;
};

/// The largest true current of the three motors.
double largest_current_A(device::ControlClient& control);

/// The middle of the default arm's box, within its reach.
inline constexpr device::Vector3 free_point_m{0.0, 0.0, -0.03};
/// The point so far from it.
constexpr device::Vector3 beside(double x_m, double y_m, double z_m) {
  return {free_point_m[0] + x_m, free_point_m[1] + y_m, free_point_m[2] + z_m};
}

}  // namespace inkwell::tests
