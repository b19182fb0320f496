// Tests that redrawing only the changed parts produces the same picture.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

double drawn_part(const Sight& sight) { return sight.all.at("drawn_part"); }

/// The window does not draw pose changes that nobody can see (differs_visibly). Such a change may move the edges of the
/// stylus by a part of a pixel.
bool looks_equal(std::uint8_t one, std::uint8_t other) {
  constexpr int least_visible = 40;
  return std::abs(one - other) < least_visible;
}

/// Returns the rectangle of the pixels that differ, or an empty text. Leaves out the status bar, whose pose rate falls
/// while the board is paused.
std::string difference_below_the_status_bar(const Image& one, const Image& other) {
  constexpr std::size_t status_pixels = 54;
  if (one.width != other.width || one.height != other.height) return "the sizes differ";
  std::size_t left = one.width, right = 0, top = one.height, bottom = 0, count = 0;
  for (std::size_t y = status_pixels; y < one.height; ++y) {
    for (std::size_t x = 0; x < one.width; ++x) {
      const std::size_t i = 3 * (y * one.width + x);
      if (std::equal(&one.rgb[i], &one.rgb[i] + 3, &other.rgb[i], looks_equal)) continue;
      ++count;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  constexpr std::size_t edge_pixels = 16;  // a part that was not redrawn has hundreds
  return count <= edge_pixels ? "" : fmt::format("x {} to {}, y {} to {}", left, right, top, bottom);
}

}  // namespace

TEST_CASE("while the sphere moves and the plots scroll, the pane next to them is not redrawn") {
  WindowRig rig({"--layout", "overview"});
  rig.move_to({700, 60});
  rig.switch_force_on();
  rig.move_to({700, 60});
  rig.control.hand({.holds = true, .target_m = {0.0, 0.0, -0.03}, .stiffness_N_per_m = 600, .damping_Ns_per_m = 6});
  rig.control.dock(false);
  std::vector<device::HandWaypoint> path;
  for (int i = 0; i < 20; ++i) path.push_back({0.5 * i, {i % 2 ? 0.04 : -0.04, 0.0, -0.03}});
  rig.control.hand_path(path);
  double least = 1.0, most = 0.0;
  for (int i = 0; i < 20; ++i) {
    const double part = drawn_part(rig.look());
    least = std::min(least, part);
    most = std::max(most, part);
  }
  CHECK(most > 0.2);   // the scene is redrawn
  CHECK(least < 0.8);  // the pane column, a quarter of the window, is not redrawn
}

TEST_CASE("a window that was drawn in parts looks like a complete drawing") {
  WindowRig rig({"--layout", "contact"});
  const auto sphere = rig.look().item("scene/sphere").centre();
  rig.drag(sphere, {sphere.x + 60, sphere.y - 40});
  rig.release_mouse();
  rig.click("tabs/Guides");
  rig.click("tabs/Tuning");
  rig.click("scope/Pause");
  rig.click("scope/Signals");
  rig.wait_until("the list is there", [](const Sight& now) { return now.has("scope/search"); });
  rig.click("scope/Signals");
  rig.press_key("F1");
  rig.wait_until("the page is there", [](const Sight& now) { return now.has("Keys and mouse/Close"); });
  rig.click("Keys and mouse/Close");
  rig.move_to({700, 60});
  rig.wait_until("the message about the loaded file is gone",
                 [](const Sight& now) { return !now.has("tuning message/message"); });
  rig.control.run(0.05);  // stationary afterwards
  const auto newest = [&rig] { return rig.look().all.at("pose_at_periods").get<std::int64_t>(); };
  for (std::int64_t before = -1, now = newest(); now != before; now = newest()) before = now;  // poses in transit
  const Image in_parts = rig.picture();
  rig.resize(1200, 700);
  rig.resize(1280, 800);
  const Image as_a_whole = rig.picture();
  CHECK(difference_below_the_status_bar(in_parts, as_a_whole) == "");
}
