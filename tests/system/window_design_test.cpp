// Tests the rules of the window's design: nothing moves under the pointer, red belongs to STOP, targets are large
// enough, and cards do not hide the sphere.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "host/companion/window/frame/palette.hpp"

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

bool contains(const Item& item, Point point) {
  return point.x >= item.x && point.x <= item.x + item.width && point.y >= item.y && point.y <= item.y + item.height;
}

/// Pulls the supply down until the board reports a fault.
void raise_fault(WindowRig& rig) {
  rig.control.supply(6.0);
  rig.wait_until("a fault", [](const Sight& now) { return now.has("banner/Clear fault"); });
}

bool are_equal(const Item& a, const Item& b) {
  return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height;
}

}  // namespace

TEST_CASE("no control moves when a number is refused, when the device refuses a value, or when a fault appears") {
  WindowRig rig;
  const std::vector<std::string> controls{"tuning/wall_stiffness_N_per_m",
                                          "tuning/wall_damping_Ns_per_m",
                                          "tuning/Stiff",
                                          "tuning/Store on board",
                                          "scene/view",
                                          "tabs/Tuning",
                                          "scene/Reset view"};
  // The window has loaded a parameter file. A message of success disappears automatically.
  rig.wait_until("the message is gone", [](const Sight& now) { return !now.has("tuning message/message"); });
  const auto before = rig.look();
  const auto check_unmoved = [&](const Sight& now) {
    for (const std::string& control : controls) {
      CAPTURE(control);
      CHECK(are_equal(now.item(control), before.item(control)));
    }
  };
  rig.enter("tuning/wall_stiffness_N_per_m", "9000");
  rig.press_key("Return");
  const auto refused =
      rig.wait_until("it is refused", [](const Sight& now) { return now.says("Wall stiffness: 0 to 3000 N/m."); });
  check_unmoved(refused);
  const Item field = refused.item("tuning/wall_stiffness_N_per_m"), message = refused.item("tuning message/message");
  CHECK(message.y >= field.y + field.height);
  CHECK(message.y < field.y + 2 * field.height);
  rig.click(message.centre());
  rig.wait_until("a click closes it", [](const Sight& now) { return !now.has("tuning message/message"); });

  rig.enter("tuning/box_minimum_x_m", "400");
  rig.press_key("Return");
  check_unmoved(rig.wait_until("the device refuses it", [](const Sight& now) { return now.says("Box minimum x"); }));
  raise_fault(rig);
  const auto in_fault = rig.look();
  check_unmoved(in_fault);
  CHECK(contains(in_fault.item("scene/view"), in_fault.item("banner/Clear fault").centre()));
}

TEST_CASE("only STOP has a red fill, also in a fault") {
  WindowRig rig;
  rig.click("tuning/Factory reset");
  rig.wait_until("it asks", [](const Sight& now) { return now.has("factory reset/Erase and reset"); });
  const auto red = [&](const Image& image, const Item& stop, bool inside) {
    const window::Colour fill = window::dark_palette.danger;
    std::size_t count = 0;
    for (std::size_t y = 0; y < image.height; ++y)
      for (std::size_t x = 0; x < image.width; ++x) {
        const auto pixel = image.at(x, y);
        if (contains(stop, {static_cast<double>(x), static_cast<double>(y)}) != inside) continue;
        if (pixel.red == fill.red && pixel.green == fill.green && pixel.blue == fill.blue) ++count;
      }
    return count;
  };
  const auto check = [&] {
    const Image image = rig.picture();
    const Item stop = rig.look().item("status/STOP");
    CHECK(red(image, stop, true) > 1000);
    CHECK(red(image, stop, false) == 0);
  };
  check();
  rig.click("factory reset/Cancel");
  raise_fault(rig);
  check();
}

TEST_CASE(
    "after a fault that cleared the reference, a card and the tooltip name the next step, and its button takes it") {
  WindowRig rig;
  rig.control.dock(false);
  rig.control.run(0.5);
  rig.control.resume();
  rig.control.inject({.fault = "encoder_slip", .of = "1", .amount = 400.0});
  rig.wait_until("a fault", [](const Sight& now) { return now.state() == "fault"; });
  rig.control.heal_all();
  rig.click("banner/Clear fault");
  rig.wait_until("the position is unknown", [](const Sight& now) {
    return now.state() == "unreferenced" && now.says("Position unknown: put the stylus into the inkwell");
  });
  rig.move_to(rig.look().item("status/Switch force on").centre());
  rig.wait_until("the tooltip says why",
                 [](const Sight& now) { return now.says("Position unknown: put the stylus into the inkwell. "); });
  rig.click("scene/Into the inkwell");
  rig.wait_until("the arm is ready", [](const Sight& now) { return now.state() == "ready"; });
  CHECK(rig.look().can_click("scene/Switch force on"));
}

TEST_CASE("the card does not cover the sphere, in small windows and with large text") {
  struct Size {
    int width, height;
    const char* scale;
  };
  for (const Size size : {Size{1024, 600, "1"}, Size{900, 560, "1"}, Size{1350, 840, "1.5"}}) {
    CAPTURE(size.width);
    const double scale = std::stod(size.scale);
    WindowRig rig({"--flat-colours", "--scale", size.scale, "--width", std::to_string(std::lround(size.width / scale)),
                   "--height", std::to_string(std::lround(size.height / scale))},
                  true, "1400x900");
    const auto sight = rig.wait_until("the card is there", [](const Sight& now) { return now.has("scene/next step"); });
    const Item card = sight.item("scene/next step");
    const Point sphere = sight.item("scene/sphere").centre();
    CHECK_FALSE(contains({card.x - 15, card.y - 15, card.width + 30, card.height + 30, true}, sphere));
    CHECK(contains(sight.item("scene/view"), card.at(0, 0)));
    CHECK(contains(sight.item("scene/view"), card.at(1, 1)));
  }
}

TEST_CASE("while a guide runs, the force cannot be switched on") {
  WindowRig rig;
  rig.click("tabs/Guides");
  rig.click("guides/Current-loop tuning");
  rig.wait_until("the guide waits", [](const Sight& now) { return now.has("guides/Cancel"); });
  CHECK_FALSE(rig.look().can_click("status/Switch force on"));
  CHECK_FALSE(rig.look().has("scene/Switch force on"));
  rig.click("guides/Cancel");
  rig.wait_until("the force is offered", [](const Sight& now) { return now.can_click("status/Switch force on"); });
}

TEST_CASE("controls are at least 24 points wide and high") {
  WindowRig rig({"--layout", "contact"});
  rig.click("scope/Signals");
  rig.enter("scope/search", "supply");
  rig.wait_until("a signal is found", [](const Sight& now) { return now.has("scope/supply_V"); });
  rig.click("tabs/Tuning");
  const auto sight = rig.look();
  for (const std::string control :
       {"tuning/wall_stiffness_N_per_m", "tuning/wall_stiffness_N_per_m handle", "tuning/contact", "scope/Position",
        "scope/supply_V", "scope/Signals", "scope/Pause", "tuning splitter/handle", "status/?", "status/theme",
        "tabs/Tuning", "scene/Reset view", "tuning/Undo"}) {
    CAPTURE(control);
    REQUIRE(sight.has(control));
    CHECK(sight.item(control).width >= 23.9);
    CHECK(sight.item(control).height >= 23.9);
  }
  CHECK(sight.item("scope splitter/handle").height >= 23.9);
}

TEST_CASE("no tooltip covers the fields while a number is typed") {
  WindowRig rig;
  const auto about = [](const Sight& now) { return now.says("In files: wall_stiffness_N_per_m"); };
  rig.move_to(rig.look().item("tuning/wall_stiffness_N_per_m").centre());
  const auto sight = rig.wait_until("the tooltip is there", about);
  CHECK(sight.says("0 to 3000 N/m, default 800. In files: wall_stiffness_N_per_m"));
  rig.click("tuning/wall_stiffness_N_per_m");
  rig.type("12");
  CHECK_FALSE(about(rig.look()));
}

TEST_CASE("lengths are typed in millimeters") {
  WindowRig rig;
  const auto before = rig.look().applied_at_periods();
  rig.enter("tuning/box_maximum_x_m", "70.5");
  rig.press_key("Return");
  rig.wait_until("it took effect", [&](const Sight& now) { return now.applied_at_periods() != before; });
  CHECK(rig.close_and_read_parameters()[protocol::Parameter::box_maximum_x_m] == 0.0705f);
}

TEST_CASE("names of files in other scripts are readable") {
  const TemporaryDirectory directory;
  WindowRig rig;
  CHECK(rig.look().all.at("missing_glyphs") == 0);
  rig.click("tuning/Load");
  // Cyrillic letters are in both main fonts.
  rig.enter("choose a file/path", directory.file("\u0436\u0438\u0432.toml"));
  rig.wait_until("the letters are loaded", [](const Sight& now) {
    return now.all.at("missing_glyphs") == 0 && !now.all.at("fonts_are_loading");
  });
  CHECK(rig.look().says("Load parameters"));
}
