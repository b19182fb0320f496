// Arms on virtual boards, and time limits of tests.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include <inkwell/inkwell.h>
#include "tests/dropins/board.hpp"

namespace inkwell::tests {

/// Rest position of the stylus in the middle of the box.
inline constexpr double free_point_m[3]{0.0, 0.0, -0.03};

inline bool says(const std::string& words) {
  return std::string(inkwell_error_text()).find(words) != std::string::npos;
}

/// Sets long time limits, so that tests also pass on a busy computer.
inline inkwell_result set_patience(inkwell_arm* arm) {
  const char* const names[]{"host_timeout_s", "program_force_expiry_s"};
  const double values[]{2.0, 0.5};
  return inkwell_set_parameters(arm, names, values, 2);
}

struct VirtualArm {
  inkwell_arm* arm = nullptr;
  explicit VirtualArm(const std::string& address = "virtual") {
    const auto result = inkwell_open(address.c_str(), &arm);
    REQUIRE_MESSAGE(result == INKWELL_OK, std::string(inkwell_error_text()));
  }
  ~VirtualArm() { inkwell_close(arm); }
  VirtualArm(const VirtualArm&) = delete;
  VirtualArm& operator=(const VirtualArm&) = delete;

  /// Reads poses until a pose satisfies the condition, for at most `limit_s` of board time.
  template <class Condition>
  inkwell_pose wait_until(Condition condition, double limit_s = 5.0) {
    inkwell_pose pose;
    REQUIRE(inkwell_get_pose(arm, &pose) == INKWELL_OK);
    const double begin_s = pose.time_s;
    while (!condition(pose)) {
      REQUIRE_MESSAGE(pose.time_s < begin_s + limit_s, "the condition was not reached in time; state ",
                      static_cast<int>(pose.state), ", fault ", pose.fault, ", sources ", pose.force_sources,
                      ", force ", pose.force_N[0]);
      REQUIRE_MESSAGE(inkwell_wait_for_pose(arm, 10.0, &pose) == INKWELL_OK, std::string(inkwell_error_text()));
    }
    return pose;
  }

  void be_patient() { REQUIRE(set_patience(arm) == INKWELL_OK); }
  void hold_in_the_open() {
    wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
    REQUIRE(inkwell_move_virtual_hand(arm, free_point_m, hand_N_per_m) == INKWELL_OK);
    wait_until([](const auto& pose) { return std::hypot(pose.position_m[0], pose.position_m[1]) < 0.004; });
  }
  void make_active() {
    be_patient();
    hold_in_the_open();
    REQUIRE_MESSAGE(inkwell_enable_force(arm, 30.0) == INKWELL_OK, std::string(inkwell_error_text()));
  }
};

}  // namespace inkwell::tests
