// Takes pictures of the window's panes with the virtual board, for tools/docs/pictures. This file is not a test.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

std::string picture_file(const std::string& name) {
  const char* folder = std::getenv("INKWELL_PICTURES");
  return (folder == nullptr ? std::string(".") : std::string(folder)) + "/" + name + ".png";
}

/// A mouse position outside all items.
constexpr Point aside{700, 60};

/// The hand presses the sphere into the right wall and the floor, and moves the sphere along their common edge.
void push_into_two_walls(WindowRig& rig) {
  rig.switch_force_on();
  const auto sight = rig.look();
  const auto sphere = sight.item("scene/sphere").centre();
  const auto right = sight.item("scene/box_maximum_x_m").centre();
  const Point edge{right.x + 25, sphere.y + 45};
  rig.drag(sphere, {sphere.x + 20, sphere.y - 40}, 12);
  for (int step = 1; step <= 48; ++step) {
    const double angle_rad = 2 * std::numbers::pi * step / 16;
    const double part = std::min(1.0, step / 16.0);
    rig.move_to({std::lerp(sphere.x + 20, edge.x, part) + 10 * std::sin(angle_rad),
                 std::lerp(sphere.y - 40, edge.y, part) + 6 * std::sin(0.5 * angle_rad)});
  }
}

/// Presses gently, so that the line of the force law is visible. The hand remains there.
void press_against_the_right_wall(WindowRig& rig) {
  const auto start_m = rig.true_probe_m();
  rig.control.hand({.holds = true, .target_m = start_m, .stiffness_N_per_m = 600, .damping_Ns_per_m = 6});
  rig.control.dock(false);
  rig.control.hand_path({{0.0, start_m},
                         {1.0, {0.0, 0.0, -0.03}},
                         {1.6, {0.05, 0.0, -0.03}},
                         {2.6, {0.088, 0.005, -0.03}},
                         {3.2, {0.080, 0.0, -0.03}}});
  rig.control.run(3.4);
}

}  // namespace

TEST_CASE("pictures: the whole window, dark and light" * doctest::skip()) {
  for (const std::string theme : {"dark", "light"}) {
    WindowRig rig({"--layout", "paper", "--theme", theme});
    rig.click("tuning/Soft");
    push_into_two_walls(rig);
    rig.picture(picture_file(theme == "dark" ? "window" : "light"));
  }
}

TEST_CASE("pictures: a program for an Omni drives" * doctest::skip()) {
  WindowRig rig({"--layout", "contact"});
  const auto sphere = rig.look().item("scene/sphere").centre();
  rig.drag(sphere, {sphere.x + 30, sphere.y - 50}, 12);
  RunningProgram program({build_directory() + "/inkwell", "run", "--usbip", rig.board.usbip().text(),
                          build_directory() + "/drop-in-well"});
  program.read_line();
  rig.wait_until("the program drives", [](const Sight& now) { return now.state() == "active"; });
  // The hand slows down gradually and finally rests.
  for (int step = 1; step <= 60; ++step) {
    const double part = step / 60.0, angle_rad = 3 * std::numbers::pi * part * (2 - part);
    rig.move_to({sphere.x + 30 + 60 * std::sin(angle_rad), sphere.y - 50 + 35 * (1 - std::cos(angle_rad))});
  }
  rig.picture(picture_file("dropins"));
  program.write_line("");
}

TEST_CASE("pictures: an object is touched, then grabbed and turned" * doctest::skip()) {
  WindowRig rig({"--layout", "contact", "feel", "--example", "skull"});
  rig.wait_until("the skull is drawn", [](const Sight& now) { return !now.says("loading"); });
  rig.switch_force_on();
  const auto start_m = rig.true_probe_m();
  rig.control.hand({.holds = true, .target_m = start_m, .stiffness_N_per_m = 250, .damping_Ns_per_m = 3});
  rig.control.dock(false);
  constexpr device::Vector3 pressed_m{0.010, 0.026, -0.022};
  rig.control.hand_path({{0.0, start_m}, {0.8, {0.06, 0.0, 0.03}}, {1.6, {0.05, 0.06, -0.01}}, {2.2, pressed_m}});
  rig.control.run(2.4);
  rig.control.resume();
  rig.move_to(aside);
  rig.picture(picture_file("object-touched"));
  rig.control.buttons(true, false);
  rig.control.hand_path({{0.0, pressed_m}, {0.3, pressed_m}, {1.6, {-0.03, 0.05, 0.0}}});
  rig.control.run(2.0);
  rig.control.resume();
  rig.picture(picture_file("object-grabbed"));
}

TEST_CASE("pictures: small and large windows, and 192 dots per inch" * doctest::skip()) {
  struct Size {
    const char *width, *height, *scale;
  };
  for (const Size size : {Size{"900", "560", "1"},
                          {"1920", "1080", "1"},
                          {"2560", "1440", "1"},
                          {"3840", "2160", "1"},
                          {"1280", "800", "2"}})
    for (const std::string theme : {"dark", "light"}) {
      WindowRig rig(
          {"--layout", "wall", "--theme", theme, "--width", size.width, "--height", size.height, "--scale", size.scale},
          true, "3840x2160");
      rig.click("tuning/Soft");
      rig.click("scope/Signals");
      rig.switch_force_on();
      press_against_the_right_wall(rig);
      rig.control.resume();
      rig.click("tabs/Log");
      rig.picture(
          picture_file(std::string("size ") + size.width + "x" + size.height + " scale " + size.scale + " " + theme));
    }
}

TEST_CASE("pictures: a soft wall, the explanation of the proxy, and an injected fault are drawn" * doctest::skip()) {
  WindowRig rig({"--layout", "wall"});
  rig.enter("tuning/wall_stiffness_N_per_m", "250");
  rig.press_key("Return");
  push_into_two_walls(rig);
  rig.picture(picture_file("soft-wall"));
  rig.release_mouse();
  rig.click("tabs/Faults");
  const auto start_m = rig.true_probe_m();
  rig.control.hand({.holds = true, .target_m = start_m, .stiffness_N_per_m = 600, .damping_Ns_per_m = 6});
  rig.control.hand_path({{0.0, start_m}, {0.8, {0.0, 0.0, -0.03}}, {1.6, {0.095, 0.0, -0.03}}});
  rig.control.run(2.0);
  rig.control.resume();
  rig.wait_until("it presses", [](const Sight& now) { return now.has("scene/proxy"); });
  rig.move_to(rig.look().item("scene/proxy").centre());
  rig.picture(picture_file("proxy"));
  rig.move_to(aside);
  rig.control.inject({.fault = "shunt_high", .of = "1"});
  rig.wait_until("it is noticed",
                 [](const Sight& now) { return now.state() == "fault" && now.says("Reported fault: "); });
  rig.picture(picture_file("injected-fault"));
}

TEST_CASE("pictures: the sliders of every group of parameters" * doctest::skip()) {
  WindowRig rig;
  constexpr int rows_that_fit = 18, wheel_steps_over_all = 12;
  const auto item = [](std::string_view name) { return "tuning/" + std::string(name); };
  const auto each_group = [](auto action) {
    std::string_view group;
    for (const auto& row : protocol::parameter_table)
      if (row.group != group) action(row.name, group = row.group);
  };
  each_group([&](std::string_view first, std::string_view group) {
    if (rig.look().has(item(first))) rig.click(item(group));  // closes the group
  });
  each_group([&](std::string_view, std::string_view group) {
    rig.click(item(group));
    const std::string name = "parameters of " + std::string(group);
    rig.picture(picture_file(name));
    if (std::ranges::count(protocol::parameter_table, group, &protocol::ParameterInfo::group) > rows_that_fit) {
      const auto over = rig.look().item(item(group)).centre();
      rig.scroll_down(over, wheel_steps_over_all);
      rig.picture(picture_file(name + ", the rest"));
      rig.scroll_up(over, wheel_steps_over_all);
    }
    rig.click(item(group));
  });
}

TEST_CASE("pictures: the scope with statistics and cursors" * doctest::skip()) {
  WindowRig rig({"--layout", "paper"});
  rig.drag(rig.look().item("scope splitter/handle").centre(), {400, 330});
  rig.release_mouse();
  push_into_two_walls(rig);
  rig.release_mouse();
  rig.click("scope/Pause");
  rig.click("scope/Statistics");
  rig.click("scope/Cursors");
  rig.move_to(aside);
  rig.picture(picture_file("scope"));
}

TEST_CASE("pictures: before the force is on, a number that is typed, and the keys" * doctest::skip()) {
  WindowRig rig({"--layout", "paper"});
  rig.enter("tuning/wall_stiffness_N_per_m", "1,5");
  rig.press_key("Return");
  rig.enter("tuning/wall_damping_Ns_per_m", "3.5");
  rig.move_to(aside);
  rig.picture(picture_file("typing"));
  rig.click("status/?");
  rig.picture(picture_file("keys"));
}

TEST_CASE("pictures: values that are not stored, the questions, and a reconnection" * doctest::skip()) {
  for (const std::string theme : {"dark", "light"})
    for (const bool is_small : {false, true}) {
      WindowRig rig({"--layout", "paper", "--theme", theme, "--width", is_small ? "900" : "1280", "--height",
                     is_small ? "560" : "800"});
      const std::string name = "store " + theme + (is_small ? " small" : "");
      const auto photograph = [&](const std::string& what) {
        rig.move_to(aside);
        rig.picture(picture_file(name + ", " + what));
      };
      rig.click("tuning/Stiff");
      rig.wait_until("they wait", [](const Sight& now) { return now.says("3 values are not stored"); });
      photograph("waiting");
      rig.switch_force_on();
      photograph("force on");
      rig.press_key("F12");
      rig.click("tuning/Factory reset");
      rig.picture(picture_file(name + ", question"));
      rig.click("factory reset/Cancel");
      rig.control.reset();
      rig.wait_until("it is back", [](const Sight& now) { return now.says("values have changed"); });
      photograph("again");
      rig.click("returned/Restore old values");
      rig.click("tuning/Store on board");
      rig.wait_until("they are stored", [](const Sight& now) { return now.says("All values are stored"); });
      photograph("stored");
      rig.control.reset();
      rig.wait_until("it is back", [](const Sight& now) { return now.says("No value has changed"); });
      photograph("the same");
    }
}

TEST_CASE("pictures: a guide with its result, in a small window too" * doctest::skip()) {
  for (const bool is_small : {false, true}) {
    WindowRig rig({"--layout", "paper", "--width", is_small ? "900" : "1280", "--height", is_small ? "560" : "800"});
    const auto photograph = [&](const std::string& what) {
      rig.move_to(is_small ? Point{300, 110} : aside);
      rig.picture(picture_file(what + (is_small ? ", small" : "")));
    };
    rig.click("tabs/Guides");
    photograph("guides");
    rig.scroll_down(rig.look().item("guides/Directions").centre(), 20);
    rig.click("guides/Current-loop tuning");
    rig.wait_until("the guide has finished", [&](const Sight& now) {
      if (now.can_click("guides/Confirm")) rig.click(now.item("guides/Confirm").centre());
      return now.has("guides/Apply");
    });
    photograph("guide");
    rig.scroll_down(rig.look().item("guides/Apply").at(0.5, -3), 20);
    photograph("guide, the rest");
    rig.click("guides/Apply");
    rig.wait_until("it offers to store", [](const Sight& now) { return now.has("guides/Store on board"); });
    photograph("guide, applied");
  }
}

TEST_CASE("pictures: faults put into the simulation, dark and light, large and small" * doctest::skip()) {
  for (const std::string theme : {"dark", "light"})
    for (const bool is_small : {false, true}) {
      WindowRig rig({"--layout", "paper", "--theme", theme, "--width", is_small ? "900" : "1280", "--height",
                     is_small ? "560" : "800"});
      const std::string name = "faults " + theme + (is_small ? " small" : "");
      rig.click("tabs/Faults");
      rig.move_to(aside);
      rig.picture(picture_file(name + ", none"));
      rig.switch_force_on();
      rig.control.inject({.fault = "encoder_lost_counts", .of = "2"});
      rig.control.inject({.fault = "shunt_high", .of = "1"});
      rig.wait_until("it is noticed", [](const Sight& now) { return now.says("Reported fault: "); });
      rig.enter("faults/search", "leg");
      rig.press_key("Down");
      rig.press_key("Down");
      rig.press_key("Return");
      rig.wait_until("the location field is active", [](const Sight& now) { return now.is_active("faults/location"); });
      rig.type("9Z");
      rig.press_key("Return");
      rig.wait_until("it is refused", [](const Sight& now) { return now.says("is no leg"); });
      rig.move_to(aside);
      rig.picture(picture_file(name));
    }
}

TEST_CASE("pictures: recording and replay" * doctest::skip()) {
  const TemporaryDirectory directory;
  WindowRig rig({"--layout", "paper"});
  rig.click("tabs/Recording");
  rig.enter("recording/file", directory.file("push.h5"));
  rig.click("recording/Start recording");
  push_into_two_walls(rig);
  rig.release_mouse();
  rig.enter("recording/mark text", "corner");
  rig.click("recording/Mark");
  rig.move_to(aside);
  rig.picture(picture_file("recording"));
  rig.click("recording/Stop recording");
  rig.click("recording/Replay last recording");
  rig.wait_until("it asks", [](const Sight& now) { return now.has("force before replay/Cancel"); });
  rig.picture(picture_file("question"));
  rig.click("force before replay/Stop and replay");
  rig.wait_until("it plays", [](const Sight& now) { return now.says("REPLAY"); });
  rig.move_to(aside);
  rig.control.run(2.0);
  rig.control.resume();
  rig.picture(picture_file("replay"));
}

TEST_CASE("pictures: a fault, no device, and choosing a file" * doctest::skip()) {
  WindowRig rig({"--layout", "paper"});
  rig.click("tuning/Load");
  rig.picture(picture_file("file"));
  rig.click("choose a file/Cancel");
  rig.move_to(aside);
  rig.control.supply(6.0);
  rig.wait_until("a fault", [](const Sight& now) { return now.state() == "fault"; });
  rig.picture(picture_file("fault"));
  rig.control.usb(false);
  rig.wait_until("it says so", [](const Sight& now) { return now.says("No arm was found"); });
  rig.picture(picture_file("unplugged"));
}

TEST_CASE("pictures: every pane in a small, a usual and a large window, dark and light" * doctest::skip()) {
  struct Size {
    const char *width, *height, *scale, *screen;
  };
  for (const Size size : {Size{"1024", "600", "1", "1024x600"}, Size{"1280", "800", "1", "1280x800"},
                          Size{"1920", "1080", "2", "3840x2160"}})
    for (const std::string theme : {"dark", "light"}) {
      const TemporaryDirectory directory;
      WindowRig rig({"--layout", "contact", "--theme", theme, "--width", size.width, "--height", size.height, "--scale",
                     size.scale},
                    true, size.screen);
      const auto photograph = [&](const std::string& what) {
        rig.look();
        rig.picture(picture_file(std::string("pane ") + size.screen + " " + theme + " " + what));
      };
      rig.wait_until("the message is gone", [](const Sight& now) { return !now.has("tuning message/message"); });
      rig.enter("tuning/sphere_radius_m", "9000");  // visible in the smallest window
      rig.press_key("Return");
      rig.wait_until("it is refused", [](const Sight& now) { return now.says(" mm."); });
      photograph("tuning");
      rig.enter("tuning/sphere_radius_m", "6");
      rig.press_key("Return");
      rig.click("tabs/Guides");
      photograph("guides");
      rig.click("tabs/Recording");
      rig.enter("recording/file", directory.file("push.h5"));
      rig.press_key("ctrl+r");
      rig.switch_force_on();
      press_against_the_right_wall(rig);
      rig.control.resume();
      rig.press_key("ctrl+m");
      rig.click("scope/Statistics");
      photograph("recording");
      rig.press_key("ctrl+r");
      rig.click("tabs/Faults");
      rig.enter("faults/search", "wire open");
      rig.click("faults/wire_open");
      photograph("faults");
      rig.click("scope/Statistics");
      rig.control.supply(6.0);
      rig.wait_until("a fault", [](const Sight& now) { return now.state() == "fault"; });
      rig.control.run(0.6);
      rig.control.resume();
      rig.click("tabs/Log");
      photograph("log and fault");
      rig.click("scope/Position");
      photograph("plot menu");
      rig.press_key("Escape");
      rig.control.supply(18.0);
      rig.click("banner/Clear fault");
      rig.click("tabs/Recording");
      if (const auto pane = rig.look(); !pane.has("recording/Replay last recording"))
        rig.scroll_down(pane.item("recording/Save last 60 s").centre(), 10);
      rig.click("recording/Replay last recording");
      rig.wait_until("it plays", [](const Sight& now) { return now.says("REPLAY"); });
      photograph("replay");
    }
}
