// Checks the colors in pictures of the window (software OpenGL, Xvfb). Compares the pictures with the true state of the
// board.
#include <doctest/doctest.h>

#include <fstream>
#include <string>

#include "host/companion/window/frame/palette.hpp"

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;
namespace colours = inkwell::window::scene_colours;

namespace {

std::size_t count(const Image& image, window::Colour colour) {
  return image.count({colour.red, colour.green, colour.blue}, 2);
}

/// Returns the region of the picture with arm, sphere and walls. Lines of the scope have the same colors, so the scope
/// is outside this region.
Image scene_of(WindowRig& rig) {
  const Image whole = rig.picture();
  const auto scene = rig.look().item("scene/view");
  const auto left = static_cast<std::size_t>(scene.x), top = static_cast<std::size_t>(scene.y);
  Image part{static_cast<std::size_t>(scene.width), static_cast<std::size_t>(scene.height), {}};
  for (std::size_t y = top; y < top + part.height; ++y) {
    const auto row = whole.rgb.begin() + static_cast<std::ptrdiff_t>(3 * (y * whole.width + left));
    part.rgb.insert(part.rgb.end(), row, row + static_cast<std::ptrdiff_t>(3 * part.width));
  }
  return part;
}

const float wall_x_m = protocol::info(Parameter::box_maximum_x_m).default_value;
const float radius_m = protocol::info(Parameter::sphere_radius_m).default_value;

/// Drags the sphere to the center of the box, and then through the right wall.
void drag_through_the_right_wall(WindowRig& rig) {
  const auto sight = rig.look();
  const auto left = sight.item("scene/box_minimum_x_m").centre(), right = sight.item("scene/box_maximum_x_m").centre();
  const Point middle{0.5 * (left.x + right.x), 0.5 * (left.y + right.y)};
  rig.drag(sight.item("scene/sphere").centre(), middle, 12);
  rig.wait_until("the sphere has come to the middle", [&](const Sight& now) {
    return std::abs(now.item("scene/sphere").x - middle.x) < 20 && std::abs(now.item("scene/sphere").y - middle.y) < 20;
  });
  for (int step = 1; step <= 16; ++step)
    rig.move_to({middle.x + 0.125 * step * (right.x - middle.x), middle.y + 0.125 * step * (right.y - middle.y)});
}

double hand_target_x_m(WindowRig& rig) { return rig.control.truth().at("hand_target_x_m"); }

}  // namespace

TEST_CASE("the window draws the box and the sphere, and no wall pushes while the force is off") {
  WindowRig rig;
  const auto scene = scene_of(rig);
  CHECK(count(scene, colours::probe) > 50);
  CHECK(count(scene, colours::wall_idle) > 300);
  CHECK(count(scene, colours::wall_touched) == 0);
  CHECK(scene.colours() > 200);
}

TEST_CASE("with the force off the mouse drags the sphere through a wall") {
  WindowRig rig;
  drag_through_the_right_wall(rig);
  rig.wait_until("the sphere is behind the wall", [&](const Sight&) { return rig.true_probe_m()[0] > wall_x_m; });
  CHECK(count(scene_of(rig), colours::wall_touched) == 0);
}

TEST_CASE("with the force on the hand goes on, the sphere stays at the wall, and the wall lights up") {
  WindowRig rig;
  rig.switch_force_on();
  drag_through_the_right_wall(rig);
  rig.wait_until("the hand is behind the wall", [&](const Sight&) { return hand_target_x_m(rig) > wall_x_m + 0.004; });
  rig.control.run(0.5);  // the arm comes to rest
  const double probe_x_m = rig.true_probe_m()[0];
  CHECK(probe_x_m > wall_x_m - radius_m);          // in contact with the wall
  CHECK(probe_x_m < wall_x_m - radius_m + 0.008);  // within the deflection of its stiffness
  CHECK(hand_target_x_m(rig) > probe_x_m + 0.008);
  rig.control.resume();
  const auto scene = scene_of(rig);
  CHECK(count(scene, colours::wall_touched) > 100);
  CHECK(count(scene, colours::wall_idle) > 100);  // the other walls are unchanged
  CHECK(count(scene, colours::hand) > 20);        // the spring of the hand
}
