// Simulates the user of a guide with the hand of a virtual board.
#pragma once

#include <deque>
#include <functional>

#include "host/client/device/control_client.hpp"
#include "host/client/guides/step.hpp"

namespace inkwell::guides {

class SimulatedUser {
 public:
  /// `arm` contains the parameters of the simulated arm, which may differ from the device's parameters.
  SimulatedUser(device::ControlClient control, const protocol::ParameterSet& arm);

  /// Call repeatedly with the task of the guide's present step. Throws device::Error on errors of the control socket.
  void advance(const UserTask& task);

 private:
  using Joints = std::array<double, 3>;
  struct Action {
    double at_s;  ///< board time
    std::function<void()> act;
  };
  void begin(const UserTask& task, double now_s);
  double move(std::vector<Joints> through, double stiffness_N_per_m);
  void move_to_stops(int joint, double now_s);
  void press_button(int button, double at_s);
  device::Vector3 probe_m(const Joints& joints) const;
  double limit_rad(int joint, bool upper) const;
  Joints inkwell() const;

  device::ControlClient control_;
  protocol::ParameterSet arm_;
  UserTask task_;
  Joints joints_{};  ///< target joint angles of the hand
  device::Vector3 gimbal_rad_{};
  std::deque<Action> planned_;
};

}  // namespace inkwell::guides
