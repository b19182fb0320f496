// Tests the window without a mouse: keys for panes and controls, and arrow keys with modifiers.
#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "protocol/parameters.hpp"

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

std::string part_of(const std::string& item) { return item.substr(0, item.find('/')); }

/// Presses the key repeatedly. Returns the panes that receive the keyboard focus, until the first pane receives it
/// again.
std::vector<std::string> tour(WindowRig& rig, const std::string& key) {
  std::vector<std::string> parts;
  for (int step = 0; step < 12; ++step) {
    rig.tap_key(key);
    const std::string part = part_of(rig.look().with_keyboard());
    if (!parts.empty() && part == parts.front()) return parts;
    parts.push_back(part);
  }
  return parts;
}

void go_to_part(WindowRig& rig, const std::string& part) {
  for (int step = 0; step < 12 && part_of(rig.look().with_keyboard()) != part; ++step) rig.tap_key("ctrl+Tab");
  REQUIRE(part_of(rig.look().with_keyboard()) == part);
}

/// Presses the key until the item has the keyboard focus. Returns all items that had the keyboard focus, including the
/// last item.
std::set<std::string> go_to(WindowRig& rig, const std::string& key, const std::string& item, int steps_maximum) {
  std::set<std::string> on_the_way;
  for (int step = 0; step < steps_maximum; ++step) {
    const std::string now = rig.look().with_keyboard();
    on_the_way.insert(now);
    if (now == item) return on_the_way;
    rig.tap_key(key);
  }
  FAIL("The key ", key, " has not come to ", item, " but to ", rig.look().with_keyboard());
  return on_the_way;
}

double distance_m(const device::Vector3& a, const device::Vector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

TEST_CASE("Ctrl+Tab gives the keyboard to every part of the window, and back") {
  WindowRig rig;
  const std::vector<std::string> onward = tour(rig, "ctrl+Tab");
  CHECK(std::set(onward.begin(), onward.end()) == std::set<std::string>{"status", "scene", "tabs", "tuning", "scope"});
  CHECK(onward.size() == 5);
  std::vector<std::string> back = tour(rig, "ctrl+shift+Tab");
  CHECK(back.size() == 5);
  CHECK(back[0] == onward.back());
}

TEST_CASE("every number of Tuning is reached by the arrow, typed and sent") {
  WindowRig rig;
  rig.tap_key("F3");
  rig.wait_until("the guides have the keyboard",
                 [](const Sight& now) { return part_of(now.with_keyboard()) == "guides"; });
  rig.tap_key("F2");
  rig.wait_until("tuning has it", [](const Sight& now) { return part_of(now.with_keyboard()) == "tuning"; });
  const auto on_the_way = go_to(rig, "Down", "tuning/wall_damping_Ns_per_m", 40);
  for (const char* passed : {"tuning/box_minimum_x_m", "tuning/box_maximum_z_m", "tuning/wall_stiffness_N_per_m"}) {
    CAPTURE(passed);
    CHECK(on_the_way.contains(passed));
  }
  const auto before = rig.look().applied_at_periods();
  rig.tap_key("Return");
  rig.wait_until("it is typed in", [](const Sight& now) { return now.is_active("tuning/wall_damping_Ns_per_m"); });
  rig.type("1.5");
  rig.tap_key("Return");
  rig.wait_until("it took effect", [&](const Sight& now) { return now.applied_at_periods() != before; });
  rig.wait_until("the next is reached", [&rig](const Sight& now) {
    if (now.with_keyboard() != "tuning/wall_damping_Ns_per_m") return true;
    rig.tap_key("Down");
    return false;
  });
  CHECK(rig.close_and_read_parameters()[protocol::Parameter::wall_damping_Ns_per_m] == doctest::Approx(1.5));
}

TEST_CASE("Enter in the signal list adds a plot for the selected signal") {
  WindowRig rig({"--layout", "contact"});
  go_to_part(rig, "scope");
  go_to(rig, "Right", "scope/Signals", 12);
  rig.tap_key("Return");
  rig.wait_until("the list is there", [](const Sight& now) { return now.has("scope/search"); });
  go_to(rig, "Left", "scope/layout", 12);
  rig.tap_key("Down");
  go_to(rig, "Left", "scope/search", 5);
  rig.tap_key("Return");
  rig.type("supply");
  rig.wait_until("it is found", [](const Sight& now) { return now.has("scope/supply_V"); });
  rig.tap_key("Return");
  go_to(rig, "Down", "scope/supply_V", 12);
  rig.tap_key("Return");
  rig.click("scope/Signals");  // without the list only the plot's title has this name
  rig.wait_until("the list is gone", [](const Sight& now) { return !now.has("scope/search"); });
  CHECK(rig.look().has("scope/supply_V"));
}

TEST_CASE("the arrows turn the scene, move the hand and the lines between the parts") {
  WindowRig rig;
  go_to_part(rig, "scene");
  const auto turns_by = [&rig](const std::string& key) {
    const auto x = [](const Sight& now) { return now.item("scene/box_maximum_x_m").x; };
    const auto before = x(rig.look());
    rig.tap_key(key);
    rig.wait_until("the scene turns by " + key, [&](const Sight& now) { return std::abs(x(now) - before) > 2.0; });
  };
  turns_by("shift+Right");
  // xdotool releases Shift before it releases the arrow key. Shift must have an effect if it was pressed in an earlier
  // frame than the arrow key.
  rig.hold_key("shift");
  turns_by("shift+Left");
  turns_by("shift+Prior");

  const device::Vector3 held_m = rig.true_probe_m();
  for (int step = 0; step < 5; ++step) rig.tap_key("ctrl+Right");
  rig.control.run(0.5);
  rig.control.resume();
  CHECK(distance_m(rig.true_probe_m(), held_m) > 0.007);

  const auto view = rig.look().item("scene/view");
  rig.tap_key("alt+Left");
  // A busy machine may repeat the key.
  rig.wait_until("the scene is narrower",
                 [&](const Sight& now) { return now.item("scene/view").width < view.width - 19; });
  rig.tap_key("alt+Up");
  rig.wait_until("the scene is lower",
                 [&](const Sight& now) { return now.item("scene/view").height < view.height - 19; });
}

TEST_CASE("Escape leaves the keyboard where it is, and a button that changes its name keeps it") {
  WindowRig rig;
  go_to_part(rig, "status");
  go_to(rig, "Right", "status/Switch force on", 20);
  rig.tap_key("Return");
  rig.wait_until("the force is on", [](const Sight& now) { return now.state() == "active"; });
  CHECK(rig.look().with_keyboard() == "status/Force is on");
  rig.tap_key("Escape");
  rig.wait_until("it is off", [](const Sight& now) { return now.state() == "ready"; });
  CHECK(rig.look().with_keyboard() == "status/Switch force on");
}

TEST_CASE("the space bar stops the force and does not press the focused control") {
  WindowRig rig;
  rig.switch_force_on();
  go_to_part(rig, "scope");
  go_to(rig, "Right", "scope/Signals", 12);
  rig.tap_key("space");
  rig.wait_until("the force is off", [](const Sight& now) { return now.state() == "ready"; });
  CHECK_FALSE(rig.look().has("scope/search"));
  CHECK(rig.look().with_keyboard() == "scope/Signals");

  rig.hold_key("space");
  CHECK_FALSE(rig.look().is_active("scope/Signals"));
  rig.release_key("space");
  CHECK_FALSE(rig.look().has("scope/search"));
  rig.tap_key("Return");  // the control reacts to the key that presses it
  CHECK(rig.look().has("scope/search"));
}

TEST_CASE("Enter twice does not forget a calibration") {
  WindowRig rig;
  rig.tap_key("F2");
  go_to(rig, "Down", "tuning/Store on board", 60);
  go_to(rig, "Right", "tuning/Factory reset", 3);
  rig.tap_key("Return");
  CHECK(rig.look().with_keyboard() == "factory reset/Cancel");
}

TEST_CASE("the page of keys is whole in the smallest window") {
  WindowRig rig;
  rig.resize(900, 560);
  rig.tap_key("F1");
  const auto close =
      rig.wait_until("it is there", [](const Sight& now) { return now.can_click("Keys and mouse/Close"); })
          .item("Keys and mouse/Close");
  CHECK(close.y + close.height < 550);  // no scrolling is needed
  CHECK(rig.look().says("Choose signals and plot type"));
}
