// On this virtual board, time advances only on request. The same calls produce the same run on any machine.
#pragma once

#include "host/client/device/control_client.hpp"
#include "host/client/device/virtual_board.hpp"

namespace inkwell::tests {

inline device::VirtualBoardOptions stepped_board(device::SimulationMode mode, device::CyclePricing pricing) {
  device::VirtualBoardOptions options;
  options.mode = mode;
  options.pricing = pricing;
  options.real_time = false;
  options.paused = true;
  return options;
}

/// Lets the hand pull the stylus out of the inkwell and move it to a point of the workspace. Returns the duration until
/// the stylus rests at this point, in seconds of board time.
inline double bring_stylus(device::ControlClient& control, device::Vector3 target_m, double duration_s) {
  constexpr double comes_to_rest_s = 0.3;
  const auto truth = control.truth();
  const device::Vector3 here_m{truth.at("true_position_x_m"), truth.at("true_position_y_m"),
                               truth.at("true_position_z_m")};
  control.hand({.holds = true, .target_m = here_m, .stiffness_N_per_m = 1500, .damping_Ns_per_m = 15});
  control.dock(false);
  control.hand_path({{0.0, here_m}, {duration_s, target_m}});
  return duration_s + comes_to_rest_s;
}

}  // namespace inkwell::tests
