// User input in the window: sliders, files, the stop button, and the latency of their effects.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;

namespace {

const std::string stiffness_handle = "tuning/wall_stiffness_N_per_m handle";
constexpr double points_of_whole_range = 1000;  // drag distance of a handle over the whole range
constexpr std::uint32_t periods_per_usb_frame = protocol::servo_rate_Hz / 1000;

/// Reads the current control period of the board from the trace, which has one row per period.
class BoardClock {
 public:
  explicit BoardClock(device::ControlClient& control) : control_(control) { control_.trace_start(); }
  std::uint32_t newest_period() {
    for (;;) {
      const auto trace = control_.trace_read(5000);
      if (trace.row_count() == 0) return newest_;
      newest_ = static_cast<std::uint32_t>(trace.values[(trace.row_count() - 1) * trace.columns.size()]);
    }
  }

 private:
  device::ControlClient& control_;
  std::uint32_t newest_ = 0;
};

}  // namespace

TEST_CASE("the device holds the value to which a handle was dragged, with Shift ten times as fast, with Ctrl a tenth") {
  WindowRig rig;
  struct Pull {
    const char* held_key;
    int points;
    double factor;
  };
  double points = 0;
  for (const auto& [held_key, by_points, factor] : {Pull{"", 60, 1}, Pull{"shift", 60, 10}, Pull{"ctrl", -60, 0.1}}) {
    const std::string key = held_key;
    const auto at = rig.look().item(stiffness_handle).centre();
    if (!key.empty()) rig.hold_key(key);
    rig.drag(at, {at.x + by_points, at.y});
    rig.release_mouse();
    if (!key.empty()) rig.release_key(key);
    points += by_points * factor;
  }
  rig.control.run(0.1);  // for its last transaction
  rig.control.resume();
  const auto held = rig.close_and_read_parameters();
  const auto& info = protocol::info(Parameter::wall_stiffness_N_per_m);
  const auto way = static_cast<float>(points / points_of_whole_range) * (info.maximum - info.minimum);
  CHECK(held[Parameter::wall_stiffness_N_per_m] == doctest::Approx(info.default_value + way).epsilon(0.003));
  auto expected = rig.parameters_at_start();
  expected[Parameter::wall_stiffness_N_per_m] = held[Parameter::wall_stiffness_N_per_m];
  CHECK(held == expected);  // no other parameter has changed
}

TEST_CASE("a dragged value is in the interrupt within two USB frames of board time") {
  WindowRig rig;
  BoardClock clock(rig.control);
  const auto handle = rig.look().item(stiffness_handle).centre();
  std::vector<std::int64_t> latencies;
  for (int attempt = 0; attempt < 5; ++attempt) {
    const auto before = rig.look().applied_at_periods();
    rig.move_to(handle);
    rig.press_mouse();
    rig.move_to({handle.x + 20, handle.y});
    rig.wait_until("the drag took effect", [&](const Sight& now) { return now.applied_at_periods() != before; });
    // Board time is paused while the event is generated and handled. The attempts differ in their phase relative to the
    // USB frame. The measurement covers only the transaction, so that a busy computer does not change the result.
    rig.control.run(2e-4 * (attempt + 1));
    const auto moved_at = clock.newest_period();
    rig.control.stand_by();
    rig.move_to({handle.x + 40, handle.y});
    const auto now =
        rig.wait_until("it took effect", [&](const Sight& sight) { return sight.applied_at_periods() > moved_at; });
    latencies.push_back(now.applied_at_periods() - moved_at);
    rig.control.resume();
    rig.release_mouse();
  }
  std::ranges::sort(latencies);
  MESSAGE("simulation: from the mouse's event to the interrupt in ", latencies.front(), " to ", latencies.back(),
          " control periods, ", latencies[latencies.size() / 2], " at the median");
  CHECK(latencies.back() <= 2 * periods_per_usb_frame);
}

TEST_CASE("a frame shows the newest pose that had arrived when it began") {
  WindowRig rig;
  for (int frame = 0; frame < 50; ++frame) {
    const auto sight = rig.look().all;
    const std::int64_t shown = sight.at("pose_at_periods"), arrived = sight.at("arrived_at_periods");
    CHECK(shown >= arrived);  // or a pose that arrived at the start of the frame
  }
}

TEST_CASE("a pose is at most three USB frames of board time old when it can be drawn") {
  WindowRig rig;
  BoardClock clock(rig.control);
  std::vector<std::int64_t> ages;
  for (int attempt = 0; attempt < 9; ++attempt) {
    rig.control.run(0.015 + 1e-4 * attempt);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // for the reports in transit to the window
    ages.push_back(clock.newest_period() - rig.look().all.at("pose_at_periods").get<std::int64_t>());
    rig.control.resume();
  }
  std::ranges::sort(ages);
  MESSAGE("simulation: the drawn pose is ", ages.front(), " to ", ages.back(), " control periods old");
  CHECK(ages[ages.size() / 2] <= 3 * periods_per_usb_frame);  // request, transmission and transfer to the window
}

TEST_CASE(
    "a parameter file that is loaded in the window sets the values of the device, and unknown names are reported") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("honey.toml");
  std::ofstream(file) << "[parameters]\nwall_damping_Ns_per_m = 3.5\nforce_limit_N = 2.25\nstickiness_N = 1.0\n";
  WindowRig rig;
  rig.click("tuning/Load");
  rig.enter("choose a file/path", file);
  const auto before = rig.look().applied_at_periods();
  rig.click("choose a file/Load");
  rig.wait_until("the device took them", [&](const Sight& now) { return now.applied_at_periods() != before; });
  CHECK(rig.look().says("stickiness_N"));
  auto expected = rig.parameters_at_start();
  expected[Parameter::wall_damping_Ns_per_m] = 3.5f;
  expected[Parameter::force_limit_N] = 2.25f;
  CHECK(rig.close_and_read_parameters() == expected);
}

TEST_CASE("a parameter file that changes the arm is loaded in the window only after a question") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("other.toml");
  std::ofstream(file) << "[parameters]\nmotor_1_reversed = 1\nforce_limit_N = 2.25\n";
  WindowRig rig;
  const auto load = [&] {
    rig.click("tuning/Load");
    rig.enter("choose a file/path", file);
    rig.click("choose a file/Load");
    rig.wait_until("the window asks", [&](const Sight& now) { return now.says("motor_1_reversed"); });
  };
  load();
  rig.click("tuning/Keep arm");
  rig.wait_until("nothing was loaded", [&](const Sight& now) { return now.says("Nothing was loaded"); });
  load();
  const auto before = rig.look().applied_at_periods();
  rig.click("tuning/Change arm");
  rig.wait_until("the device took them", [&](const Sight& now) { return now.applied_at_periods() != before; });
  auto expected = rig.parameters_at_start();
  expected[Parameter::motor_1_reversed] = 1.0f;
  expected[Parameter::force_limit_N] = 2.25f;
  CHECK(rig.close_and_read_parameters() == expected);
}

TEST_CASE("a damaged parameter file is reported, and the device retains its values") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("damaged.toml");
  std::ofstream(file) << "[parameters]\nwall_damping_Ns_per_m = 3.\nforce_limit_N = = 2\n";
  WindowRig rig;
  rig.click("tuning/Load");
  rig.enter("choose a file/path", file);
  rig.click("choose a file/Load");
  rig.wait_until("it says which file", [&](const Sight& now) { return now.says("damaged.toml"); });
  CHECK(rig.close_and_read_parameters() == rig.parameters_at_start());
}

TEST_CASE("the stop button and the space bar switch the force off, the button also over a dialog") {
  WindowRig rig;
  const auto has_stopped = [](const Sight& now) { return now.state() == "ready"; };
  rig.switch_force_on();
  rig.click("status/STOP");
  rig.wait_until("the button stopped it", has_stopped);

  rig.switch_force_on();
  rig.press_key("space");
  rig.wait_until("the space bar stopped it", has_stopped);

  rig.switch_force_on();
  rig.click("tuning/Load");  // a modal dialog with the keyboard focus
  rig.press_key("Escape");
  rig.wait_until("Escape stopped it and closed the dialog",
                 [&](const Sight& now) { return has_stopped(now) && !now.has("choose a file/Cancel"); });

  rig.switch_force_on();
  rig.click("tuning/Load");
  rig.click("status/STOP");
  rig.wait_until("the button stopped it, though a dialog has the mouse", has_stopped);
}
