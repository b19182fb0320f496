// Tests the effects of user mistakes on the arm: incomplete numbers, commas, wrong keys, and a replay while an arm is
// connected.
#include <doctest/doctest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host/companion/window/frame/value_range.hpp"

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;

namespace {

const std::string stiffness = "tuning/wall_stiffness_N_per_m";
const float stiffness_at_start = protocol::info(Parameter::wall_stiffness_N_per_m).default_value;

const auto force_is_on = [](const Sight& now) { return now.state() == "active"; };
const auto force_is_off = [](const Sight& now) { return now.state() == "ready"; };

/// Makes a change and waits until the device applies it.
void change_and_wait(WindowRig& rig, const std::function<void()>& change) {
  const auto before = rig.look().applied_at_periods();
  change();
  rig.wait_until("it took effect", [&](const Sight& now) { return now.applied_at_periods() != before; });
}

/// Waits for all pending changes and returns the device's stiffness.
float stiffness_held_at_the_end(WindowRig& rig) {
  rig.control.run(0.1);
  rig.control.resume();
  return rig.close_and_read_parameters()[Parameter::wall_stiffness_N_per_m];
}

}  // namespace

TEST_CASE("a number is not sent while it is typed, but when Enter ends it") {
  WindowRig rig;
  const auto before = rig.look().applied_at_periods();
  rig.enter(stiffness, "1500");
  rig.control.run(0.2);  // time for a half-typed number to arrive
  rig.control.resume();
  CHECK(rig.look().applied_at_periods() == before);
  rig.press_key("Return");
  rig.wait_until("it took effect", [&](const Sight& now) { return now.applied_at_periods() != before; });
  CHECK(stiffness_held_at_the_end(rig) == 1500.0f);
}

TEST_CASE("a click selects the whole number and sends nothing") {
  WindowRig rig;
  rig.click(stiffness);
  rig.type("900");  // replaces the selected text
  rig.click("tabs/Tuning");
  CHECK(stiffness_held_at_the_end(rig) == 900.0f);
}

TEST_CASE("a number is sent when a click goes elsewhere, also to a field above it") {
  WindowRig rig;
  const auto type_and_leave = [&](const char* number, const std::function<void()>& leave) {
    change_and_wait(rig, [&] {
      rig.enter(stiffness, number);
      leave();
    });
  };
  type_and_leave("1500", [&] { rig.click("tabs/Tuning"); });
  type_and_leave("1400", [&] { rig.click("tuning/sphere_radius_m"); });
  type_and_leave("1300", [&] { rig.click("tuning/wall_damping_Ns_per_m"); });
  type_and_leave("1200", [&] { rig.press_key("Tab"); });
  CHECK(stiffness_held_at_the_end(rig) == 1200.0f);
}

TEST_CASE("Escape gives back the value that was there, sends nothing, and switches the force off") {
  WindowRig rig;
  rig.switch_force_on();
  rig.enter(stiffness, "1500");
  rig.press_key("Escape");
  rig.wait_until("the force is off", force_is_off);
  CHECK(stiffness_held_at_the_end(rig) == stiffness_at_start);
}

TEST_CASE("an invalid or out-of-range number is reported and leaves the old value") {
  WindowRig rig;
  const std::vector<std::pair<std::string, std::string>> slips{
      {"1,35", "Use a decimal point and no commas."},
      {"12abc", "`12abc` is not a number"},
      {" ", "` ` is not a number"},
      {"3000.5", "Wall stiffness: 0 to 3000 N/m."},
      {"-1", "Wall stiffness: 0 to 3000 N/m."},
      {"inf", "Wall stiffness: 0 to 3000 N/m."},
  };
  const auto before = rig.look().applied_at_periods();
  for (const auto& [typed, message] : slips) {
    rig.enter(stiffness, typed);
    rig.press_key("Return");
    rig.wait_until(fmt::format("'{}' is shown", typed),
                   [&](const Sight& now) { return now.says(message) && now.says("keeps its old value"); });
    CHECK(rig.look().applied_at_periods() == before);
  }
  CHECK(stiffness_held_at_the_end(rig) == stiffness_at_start);
}

TEST_CASE("a value that the device refuses leaves the old one") {
  WindowRig rig;
  const auto upper_m = WindowRig::parameters_at_start()[Parameter::box_maximum_x_m];
  rig.enter("tuning/box_minimum_x_m", std::to_string(1000.0f * (upper_m + 0.1f)));
  rig.press_key("Return");
  rig.wait_until("it is shown", [](const Sight& now) { return now.says("Box minimum x = ") && now.says(" mm."); });
  rig.control.run(0.1);
  rig.control.resume();
  CHECK(rig.close_and_read_parameters() == WindowRig::parameters_at_start());
}

TEST_CASE("space is a space while a text is typed; Escape and F12 switch the force off, also then") {
  WindowRig rig;
  rig.click("tabs/Recording");
  for (const char* key : {"Escape", "F12"}) {
    CAPTURE(key);
    rig.switch_force_on();
    rig.enter("recording/file", "two words");
    rig.control.run(0.1);  // for a command in transit
    rig.control.resume();
    CHECK(rig.look().state() == "active");
    rig.press_key(key);
    rig.wait_until("the force is off", force_is_off);
  }
}

TEST_CASE("Ctrl+Z goes by the character, wherever the keyboard has it") {
  WindowRig rig;
  rig.set_keyboard_layout("de");
  change_and_wait(rig, [&] {
    rig.enter(stiffness, "1500");
    rig.press_key("Return");
  });
  change_and_wait(rig, [&] { rig.press_key("ctrl+z"); });
  CHECK(rig.look().can_click("tuning/Redo"));
  change_and_wait(rig, [&] { rig.press_key("ctrl+y"); });
  CHECK_FALSE(rig.look().can_click("tuning/Redo"));
  CHECK(stiffness_held_at_the_end(rig) == 1500.0f);
}

TEST_CASE("a held key undoes only one change") {
  WindowRig rig;
  for (const char* value : {"1500", "1600"})
    change_and_wait(rig, [&] {
      rig.enter(stiffness, value);
      rig.press_key("Return");
    });
  change_and_wait(rig, [&] { rig.hold_key("ctrl+z"); });
  rig.control.run(1.0);
  rig.control.resume();
  rig.release_key("ctrl+z");
  CHECK(stiffness_held_at_the_end(rig) == 1500.0f);
}

TEST_CASE("a page lists the keys") {
  WindowRig rig;
  const std::pair<const char*, std::function<void()>> ways[] = {{"F1", [&] { rig.press_key("F1"); }},
                                                                {"?", [&] { rig.press_key("question"); }},
                                                                {"its button", [&] { rig.click("status/?"); }}};
  for (const auto& [way, open] : ways) {
    CAPTURE(way);
    open();
    rig.wait_until("it is there", [](const Sight& now) { return now.says("Switch the force off at any time"); });
    rig.click("Keys and mouse/Close");
    rig.wait_until("it is gone", [](const Sight& now) { return !now.says("Switch the force off at any time"); });
  }
}

TEST_CASE("while the force is off, the scene states that walls do not push back and has a button to switch it on") {
  WindowRig rig;
  REQUIRE(rig.look().says("The force is off: walls do not push back."));
  rig.click("scene/Switch force on");
  rig.wait_until("the force is on", force_is_on);
  CHECK_FALSE(rig.look().says("The force is off"));
}

TEST_CASE("a recording is seen from every pane, and is replayed only when the force is off") {
  const TemporaryDirectory directory;
  WindowRig rig;
  rig.click("tabs/Recording");
  rig.enter("recording/file", directory.file("push.h5"));
  rig.click("recording/Start recording");
  rig.click("tabs/Tuning");
  rig.wait_until("the tab shows its time", [](const Sight& now) { return now.says("0:0"); });
  rig.click("tabs/Recording");
  rig.click("recording/Stop recording");
  rig.wait_until("it is complete", [](const Sight& now) { return now.says("push.h5 is complete"); });

  const auto asks = [](const Sight& now) { return now.has("force before replay/Cancel"); };
  const auto ask_with_force = [&] {
    rig.switch_force_on();
    rig.click("recording/Replay last recording");
    rig.wait_until("it asks", asks);
  };
  const auto check_no_replay = [&] {
    rig.control.run(0.1);  // time for the replay to start
    rig.control.resume();
    CHECK_FALSE(rig.look().says("REPLAY"));
  };
  ask_with_force();
  rig.click("status/STOP");  // does not answer the question
  rig.wait_until("the force is off", force_is_off);
  check_no_replay();
  CHECK(asks(rig.look()));
  rig.click("force before replay/Cancel");

  ask_with_force();
  rig.press_key("Escape");  // answers no
  rig.wait_until("the force is off", force_is_off);
  CHECK_FALSE(asks(rig.look()));
  check_no_replay();

  ask_with_force();
  rig.click("force before replay/Cancel");
  rig.wait_until("the question is gone", [&](const Sight& now) { return !asks(now); });
  check_no_replay();
  CHECK(rig.look().state() == "active");

  rig.click("recording/Replay last recording");
  rig.click("force before replay/Stop and replay");
  const auto replay = rig.wait_until("the replay says what it is", [](const Sight& now) { return now.says("REPLAY"); });
  CHECK(replay.state() == "ready");
  CHECK_FALSE(replay.can_click("status/Switch force on"));  // impossible during a replay
  CHECK_FALSE(replay.has("scene/Switch force on"));
  rig.control.run(0.1);
  rig.control.resume();
  CHECK(rig.look().state() == "ready");

  RunningProgram other_program(
      {build_directory() + "/inkwell", "force", "on", "--take-over", "--usbip", rig.board.usbip().text()});
  rig.wait_until("the force is on", force_is_on);
  rig.wait_until("it is shown", [](const Sight& now) { return now.says("The window shows a recording"); });
  rig.click("status/STOP");
  rig.wait_until("the force is off", force_is_off);
}

TEST_CASE("the scene explains the proxy under the mouse pointer") {
  WindowRig rig;
  const auto sight = rig.look();
  const auto right = sight.item("scene/box_maximum_x_m").centre(), sphere = sight.item("scene/sphere").centre();
  CHECK_FALSE(sight.has("scene/proxy"));
  rig.drag(sphere, {right.x + 40, sphere.y - 40}, 16);
  rig.wait_until("the sphere is in the wall", [](const Sight& now) { return now.has("scene/proxy"); });
  rig.release_mouse();
  rig.control.run(0.3);
  rig.control.resume();
  rig.drag(rig.look().item("scene/sphere").centre(), {right.x + 40, sphere.y - 40}, 8);
  rig.control.run(0.3);
  rig.control.pause();
  rig.release_mouse();
  rig.move_to(rig.look().item("scene/proxy").centre());
  rig.wait_until("it is shown", [](const Sight& now) { return now.says("A virtual spring connects the proxy"); });
}
