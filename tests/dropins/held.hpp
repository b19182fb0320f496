// An open HDAPI device in a simulated hand, and common actions of HDAPI programs.
#pragma once

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "tests/dropins/board.hpp"
#include "tests/dropins/hdapi.hpp"

namespace inkwell::tests {

/// Returns the newest error, and checks that no second error is queued.
inline HDerror only_error() {
  const auto error = hdGetError();
  CHECK(hdGetError().errorCode == HD_SUCCESS);
  return error.errorCode;
}

inline bool says(HDerror code, const std::string& words) {
  return std::string(hdGetErrorString(code)).find(words) != std::string::npos;
}

/// Evaluates `condition` in each tick of the servo thread until the condition is true. Returns false after `ticks`
/// ticks.
inline bool until(std::function<bool()> condition, int ticks = 20'000) {
  struct State {
    std::function<bool()> condition;
    int left;
    bool reached;
  } state{std::move(condition), ticks, false};
  hdScheduleSynchronous(
      [](void* user) {
        auto& self = *static_cast<State*>(user);
        self.reached = self.condition();
        return self.reached || --self.left <= 0 ? HD_CALLBACK_DONE : HD_CALLBACK_CONTINUE;
      },
      &state, HD_DEFAULT_SCHEDULER_PRIORITY);
  return state.reached;
}

inline void forget_errors() {
  while (hdGetError().errorCode != HD_SUCCESS) {
  }
}

/// An open device in a hand, with a running scheduler.
struct Held : Board {
  HHD device = hdInitDevice(nullptr);
  Held() {
    REQUIRE_MESSAGE(device != HD_INVALID_HANDLE, std::string(hdGetErrorString(hdGetError().errorCode)));
    hdStartScheduler();
    CHECK(until([] { return hdCheckCalibration() == HD_CALIBRATION_OK; }));
    hold();
    int ticks_at_rest = 0;
    CHECK(until([&] {
      double velocity_mm_per_s[3];
      frame([&] { hdGetDoublev(HD_CURRENT_VELOCITY, velocity_mm_per_s); });
      const bool is_there = std::hypot(pulled_m(0), pulled_m(1), pulled_m(2)) < 0.006;
      const bool rests = std::hypot(velocity_mm_per_s[0], velocity_mm_per_s[1], velocity_mm_per_s[2]) < 5.0;
      ticks_at_rest = is_there && rests ? ticks_at_rest + 1 : 0;
      return ticks_at_rest > 100;
    }));
    for (std::size_t i = 0; i < 3; ++i) rest_m[i] += pulled_m(i);
    forget_errors();
  }
  ~Held() {
    hdStopScheduler();
    hdDisableDevice(device);
    forget_errors();
  }
  template <class Action>
  void frame(Action action) {
    hdBeginFrame(device);
    action();
    hdEndFrame(device);
  }
  /// Repeats a frame with this action until the stylus is displaced by at least `least_m` along the axis.
  template <class Action>
  bool pulls(std::size_t axis, double least_m, double most_m, Action action) {
    return until([&, this] {
      frame(action);
      return pulled_m(axis) > least_m && pulled_m(axis) < most_m;
    });
  }
};

inline void set_force(const std::array<double, 3>& force_N) { hdSetDoublev(HD_CURRENT_FORCE, force_N.data()); }

}  // namespace inkwell::tests
