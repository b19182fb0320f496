// A virtual board with a simulated hand. Programs find the board through INKWELL_DEVICE.
#pragma once

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "host/client/device/virtual_board.hpp"

namespace inkwell::tests {

/// Rest position of the stylus in the simulated hand.
inline constexpr device::Vector3 held_point_m{0.02, 0.01, -0.03};
inline constexpr double hand_N_per_m = 300;

/// Firmware with the next version of the protocol.
inline const device::VirtualBoardOptions next_protocol{.elf = INKWELL_BUILD_DIRECTORY "/../board/next-protocol.elf"};

struct Board {
  device::VirtualBoard board;
  device::ControlClient control = board.control();
  std::string address = "usbip:" + board.usbip().text();

  device::Vector3 rest_m = held_point_m;

  /// If `paused` is set, the stylus starts outside the inkwell and the encoders are not referenced.
  explicit Board(const device::VirtualBoardOptions& options = {}) : board(options) {
    if (options.paused) {
      control.dock(false);
      control.resume();
    }
    setenv("INKWELL_DEVICE", address.c_str(), 1);
    wait_for_device();
  }
  ~Board() { unsetenv("INKWELL_DEVICE"); }

  void wait_for_device() const {
    while (!board.find()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  void hold() {
    control.hand({.holds = true, .target_m = held_point_m, .stiffness_N_per_m = hand_N_per_m, .damping_Ns_per_m = 8});
    control.dock(false);
  }
  double position_m(char axis) { return control.truth().at(std::string("true_position_") + axis + "_m").get<double>(); }
  /// Distance of the stylus from its rest position along this axis.
  double pulled_m(std::size_t axis) { return position_m("xyz"[axis]) - rest_m[axis]; }
  double time_s() { return control.status().board_time_s; }
};

}  // namespace inkwell::tests
