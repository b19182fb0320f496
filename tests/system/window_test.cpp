// The real window under Xvfb, on software OpenGL, with the virtual board: what it draws is looked for by colour.
#include <doctest/doctest.h>

#include <fstream>
#include <string>
#include <vector>

#include <window/palette.hpp>

#include "image.hpp"
#include "program.hpp"

using namespace inkwell::tests;
namespace colours = inkwell::window::scene_colours;

namespace {

/// The scene lies left of the panels and between the status bar and the scope, at 1280 x 800.
Image scene_of(const Image& window) {
  REQUIRE(window.width == 1280);
  REQUIRE(window.height == 800);
  Image scene{900, 430, {}};
  for (std::size_t y = 60; y < 490; ++y)
    scene.rgb.insert(scene.rgb.end(), window.rgb.begin() + static_cast<std::ptrdiff_t>(3 * y * window.width),
                     window.rgb.begin() + static_cast<std::ptrdiff_t>(3 * (y * window.width + 900)));
  return scene;
}

std::size_t count(const Image& image, inkwell::window::Colour colour) {
  return image.count({colour.red, colour.green, colour.blue}, 2);
}

/// Opens the window for a while; `input` is a shell command with which xdotool plays the user.
Image window_after(const TemporaryDirectory& directory, const std::string& options, const std::string& input) {
  const std::string picture = directory.file("window.png");
  const std::string script = build_directory() + "/inkwell --virtual --flat-colours --forget-settings --screenshot " + picture +
                             " --after-seconds 15 " + options + " & " + input + "; wait $!";
  const auto result =
      run_program("/usr/bin/env", {"LIBGL_ALWAYS_SOFTWARE=1", "xvfb-run", "--auto-servernum",
                                   "--server-args=-screen 0 1280x800x24", "sh", "-c", script});
  INFO("standard error: ", result.err);
  REQUIRE(result.exit_code == 0);
  return read_png(picture);
}

}  // namespace

TEST_CASE("the window draws the box and the sphere, and no wall pushes while the force is off") {
  const TemporaryDirectory directory;
  const auto window = window_after(directory, "", "true");
  const auto scene = scene_of(window);
  CHECK(count(scene, colours::probe) > 50);
  CHECK(count(scene, colours::wall_idle) > 300);
  CHECK(count(scene, colours::wall_touched) == 0);
  CHECK(window.colours() > 200);
}

TEST_CASE("with the force on, the wall that the sphere is pressed into lights up") {
  const TemporaryDirectory directory;
  // The floor of the box is raised above the sphere in the inkwell, the user clicks "Switch force on".
  const std::string parameters = directory.file("parameters.toml");
  std::ofstream(parameters) << "[parameters]\nbox_minimum_y_m = -0.072\n";
  const auto scene = scene_of(
      window_after(directory, "--parameters " + parameters, "sleep 8; xdotool mousemove 1083 27; sleep 1; xdotool click 1"));
  CHECK(count(scene, colours::wall_touched) > 100);
  CHECK(count(scene, colours::wall_idle) > 100);  // the other five stay as they were
}
