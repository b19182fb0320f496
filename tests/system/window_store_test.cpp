// Tests the display of unstored values and of values that differ after a reconnection.
#include <doctest/doctest.h>

#include <fstream>
#include <string>

#include "tests/system/window_rig.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;

namespace {

constexpr float stiff_N_per_m = 1500.0f;

const auto says = [](const std::string& words) { return [words](const Sight& now) { return now.says(words); }; };

/// One value is not stored after the window's start. With the preset, three values are not stored.
void make_stiff(WindowRig& rig) {
  rig.wait_until("one value waits", says("1 value is not stored"));
  rig.click("tuning/Stiff");
  rig.wait_until("three values wait", says("3 values are not stored"));
}

void store(WindowRig& rig) {
  rig.click("tuning/Store on board");
  rig.wait_until("they are stored", says("All values are stored"));
}

/// Restarts the board with the arm in its inkwell.
void restart(WindowRig& rig) {
  rig.control.reset();
  rig.wait_until("the window is connected again",
                 [](const Sight& now) { return now.state() == "ready" && now.says("Reconnected"); });
}

float stiffness_held_at_the_end(WindowRig& rig) {
  return rig.close_and_read_parameters()[Parameter::wall_stiffness_N_per_m];
}

}  // namespace

TEST_CASE("values that are not stored are counted; stored by a button, they outlive the power") {
  WindowRig rig;
  make_stiff(rig);
  rig.click("tabs/Guides");
  CHECK(rig.look().has("tabs/values to store"));
  rig.click("tabs/Tuning");
  CHECK_FALSE(rig.look().has("tabs/values to store"));
  store(rig);
  CHECK_FALSE(rig.look().can_click("tuning/Store on board"));
  rig.click("tabs/Guides");
  CHECK_FALSE(rig.look().has("tabs/values to store"));
  restart(rig);
  CHECK(rig.look().says("No value has changed since the last connection."));
  rig.wait_until("the message disappears", [](const Sight& now) { return !now.says("Reconnected"); });
  CHECK(stiffness_held_at_the_end(rig) == stiff_N_per_m);
}

TEST_CASE("while the force is on, parameters cannot be stored or erased, and the window states the reason") {
  WindowRig rig;
  make_stiff(rig);
  rig.switch_force_on();
  const std::string why = "The values can be stored once the force is off.";
  const auto sight = rig.wait_until("it says why", says(why));
  CHECK_FALSE(sight.can_click("tuning/Store on board"));
  CHECK_FALSE(sight.can_click("tuning/Factory reset"));
  rig.press_key("F12");
  rig.wait_until("it can be stored", [](const Sight& now) { return now.can_click("tuning/Store on board"); });
  CHECK_FALSE(rig.look().says(why));
}

TEST_CASE("the stored values are given back by a question, as one step that can be undone") {
  WindowRig rig;
  rig.wait_until("one value waits", says("1 value is not stored"));
  CHECK_FALSE(rig.look().can_click("tuning/Restore"));  // nothing is stored
  store(rig);
  rig.click("tuning/Stiff");
  rig.wait_until("two values wait", says("2 values are not stored"));
  rig.click("tuning/Restore");
  CHECK(rig.look().says("Wall stiffness: 1500 N/m, stored: 800"));
  rig.click("restore stored values/Cancel");
  CHECK(rig.look().says("2 values are not stored"));
  rig.click("tuning/Restore");
  rig.click("restore stored values/Restore");
  rig.wait_until("they are given back", says("All values are stored"));
  rig.click("tuning/Undo");
  rig.wait_until("the step is undone", says("2 values are not stored"));
  CHECK(stiffness_held_at_the_end(rig) == stiff_N_per_m);
}

TEST_CASE("a factory reset asks for confirmation, erases the stored parameters and restores the defaults") {
  WindowRig rig;
  make_stiff(rig);
  store(rig);
  rig.click("tuning/Factory reset");
  CHECK(rig.look().says("the calibration of this arm is lost"));
  rig.click("factory reset/Cancel");
  CHECK(rig.look().says("All values are stored"));
  rig.click("tuning/Factory reset");
  rig.click("factory reset/Erase and reset");
  rig.wait_until("the board has forgotten", says("All values are defaults"));
  CHECK(rig.close_and_read_parameters() == protocol::default_parameters());
}

TEST_CASE("a question about a device closes when the device is disconnected") {
  WindowRig rig;
  make_stiff(rig);
  store(rig);
  rig.click("tuning/Soft");
  const auto go_away_and_come = [&](const std::string& button, const std::string& question) {
    rig.click(button);
    rig.wait_until("it asks", [&](const Sight& now) { return now.has(question + "/Cancel"); });
    rig.control.usb(false);
    rig.wait_until("it does not ask any more", [&](const Sight& now) { return !now.has(question + "/Cancel"); });
    rig.control.usb(true);
    rig.wait_until("the window is connected again", [](const Sight& now) { return now.state() == "ready"; });
  };
  go_away_and_come("tuning/Factory reset", "factory reset");
  go_away_and_come("tuning/Restore", "restore stored values");
  rig.click("tuning/Viscous");  // an open question would block the mouse
  rig.wait_until("it is chosen", [](const Sight& now) { return now.applied_at_periods() != 0; });
}

TEST_CASE("after a power loss the window lists the changed values and sends them only on request") {
  WindowRig rig;
  make_stiff(rig);
  restart(rig);
  const auto sight = rig.look();
  CHECK(sight.says("Reconnected: 3 values have changed"));
  CHECK(sight.says("Wall stiffness"));
  CHECK(sight.says("800, was 1500 N/m"));
  rig.control.run(0.5);  // time for an automatic change to arrive
  rig.control.resume();
  CHECK(rig.look().applied_at_periods() == 0);
  SUBCASE("the old ones") {
    rig.click("returned/Restore old values");
    rig.wait_until("nothing is left to say", [](const Sight& now) { return !now.has("returned/Keep new values"); });
    CHECK(rig.look().applied_at_periods() != 0);
    CHECK(stiffness_held_at_the_end(rig) == stiff_N_per_m);
  }
  SUBCASE("these are kept") {
    rig.click("returned/Keep new values");
    CHECK_FALSE(rig.look().has("returned/Keep new values"));
    CHECK(rig.close_and_read_parameters() == protocol::default_parameters());
  }
}

TEST_CASE("a reconnected cable changes no value, and the window reports this") {
  WindowRig rig;
  make_stiff(rig);
  rig.control.usb(false);
  rig.wait_until("the window notices", [](const Sight& now) { return !now.connected(); });
  rig.control.usb(true);
  rig.wait_until("it says so", says("No value has changed since the last connection."));
  CHECK(stiffness_held_at_the_end(rig) == stiff_N_per_m);
}

TEST_CASE("a guide offers to store its changes after they are applied") {
  WindowRig rig;
  rig.click("tabs/Guides");
  rig.click("guides/Current-loop tuning");
  rig.wait_until("the guide has finished", [&](const Sight& now) {
    if (now.can_click("guides/Confirm")) rig.click(now.item("guides/Confirm").centre());
    return now.has("guides/Apply");
  });
  CHECK_FALSE(rig.look().has("guides/Store on board"));
  const TemporaryDirectory directory;
  const auto save = [&](const std::string& row, const std::string& name) {
    rig.click("guides/Save");
    rig.click_in_menu(row);
    const std::string file = directory.file(name);
    rig.enter("choose a file/path", file);
    rig.click("choose a file/Save");
    rig.wait_until(name + " is saved", says("Saved " + file));
    return file;
  };
  std::ifstream values(save("Save values (CSV)", "steps.csv"));
  std::string names;
  std::getline(values, names);
  CHECK(names.starts_with("time_ms,motor_1_before_A,"));
  CHECK(read_png(save("Save picture (PNG)", "steps.png")).colours() > 10);
  rig.click("guides/Apply");
  rig.wait_until("it offers to store", says("The values are lost at power-off unless you store them."));
  rig.click("guides/Store on board");
  rig.wait_until("it is stored", says("The values are stored on the board."));
}

TEST_CASE(
    "without a motor the force has no effect, and the scene has a button for the guide that measures the motors") {
  WindowRig rig;
  rig.control.inject({.fault = "motor_open", .of = "1"});
  restart(rig);
  rig.click("returned/Keep new values");
  rig.click("status/Switch force on");
  rig.wait_until("the reason is shown", says("No motor receives current: a motor is missing or unknown"));
  rig.click("scene/Measure motors");
  rig.wait_until("the guide waits", says("The guide waits until you press Confirm."));
  CHECK(rig.look().says("Current-loop tuning"));
  rig.wait_until("the force is off", [](const Sight& now) { return now.state() == "ready"; });
}
