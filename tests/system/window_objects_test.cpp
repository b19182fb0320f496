// Objects in the scene of the real window, and their contact points.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "host/companion/window/frame/palette.hpp"

#include "tests/system/window_rig.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;
namespace colours = inkwell::window::scene_colours;

namespace {

constexpr int exactly = 2;  // tolerance of a channel

/// The window with a cube of 50 mm, or with another mesh by the options.
class ObjectWindow {
 public:
  explicit ObjectWindow(std::vector<std::string> options = {"--flat-colours"}) : rig_(start(std::move(options))) {
    rig_->move_to({700, 60});  // no item under the mouse
  }

  /// The window never reads a part of the file.
  void place(const std::string& lines) {
    const std::string part = directory_.file("part.txt");
    std::ofstream(part) << lines;
    std::filesystem::rename(part, directory_.file("objects.txt"));
  }

  /// Waits until the picture contains at least `least` and at most `most` pixels of the object.
  std::size_t wait_for_pixels(std::size_t least, std::size_t most) {
    std::size_t pixels = 0;
    rig_->wait_until("the object is drawn", [&](const Sight&) {
      pixels = object_pixels(rig_->picture());
      return pixels >= least && pixels <= most;
    });
    return pixels;
  }

  static std::size_t object_pixels(const Image& image) {
    return image.count({colours::object.red, colours::object.green, colours::object.blue}, exactly);
  }

  WindowRig& rig() { return *rig_; }

 private:
  std::unique_ptr<WindowRig> start(std::vector<std::string> options) {
    options.insert(options.end(), {"--objects", directory_.file("objects.txt")});
    return std::make_unique<WindowRig>(options, true, WindowRig::usual_screen, "object-window");
  }

  TemporaryDirectory directory_;
  std::unique_ptr<WindowRig> rig_;
};

/// Row and column of the middle of all pixels of the object.
Point middle_of_object(const Image& image) {
  double x_sum = 0, y_sum = 0, count = 0;
  for (std::size_t y = 0; y < image.height; ++y)
    for (std::size_t x = 0; x < image.width; ++x) {
      const Colour pixel = image.at(x, y);
      if (std::abs(pixel.red - colours::object.red) > exactly ||
          std::abs(pixel.green - colours::object.green) > exactly ||
          std::abs(pixel.blue - colours::object.blue) > exactly)
        continue;
      x_sum += static_cast<double>(x), y_sum += static_cast<double>(y), ++count;
    }
  return {x_sum / count, y_sum / count};
}

}  // namespace

TEST_CASE("an object appears, moves and disappears in the scene") {
  ObjectWindow window;
  CHECK(ObjectWindow::object_pixels(window.rig().picture()) == 0);
  window.place("object 0 0 0 0\n");
  const std::size_t pixels = window.wait_for_pixels(2000, 100'000);
  const Point before = middle_of_object(window.rig().picture());
  window.place("object 0.05 0 0 0\n");
  Point now = before;
  window.rig().wait_until("the object has moved", [&](const Sight&) {
    now = middle_of_object(window.rig().picture());
    return now.x > before.x + 30;  // x points to the right
  });
  CHECK(now.y == doctest::Approx(before.y).epsilon(0.2));
  window.place("object 0 0 0 0.56\n");
  window.wait_for_pixels(1000, pixels * 9 / 10);  // the eye sees one side of the cube from the front
  window.place("");
  window.wait_for_pixels(0, 0);
}

TEST_CASE("an object outside the box is visible through the transparent walls") {
  ObjectWindow window;
  window.place("object 0.16 0 0 0\n");
  window.wait_for_pixels(1000, 100'000);
}

TEST_CASE("an object covers the sphere inside it") {
  ObjectWindow window;
  const Item view = window.rig().look().item("scene/view");
  const auto sphere_pixels = [&window, &view] {  // lines of the scope below the scene have the same color
    Image image = window.rig().picture();
    image.rgb.resize(3 * image.width * static_cast<std::size_t>(view.y + view.height));
    image.height = static_cast<std::size_t>(view.y + view.height);
    return image.count({colours::probe.red, colours::probe.green, colours::probe.blue}, exactly);
  };
  const std::size_t uncovered = sphere_pixels();
  CHECK(uncovered > 50);
  const auto [x_m, y_m, z_m] = window.rig().true_probe_m();
  window.place(fmt::format("object {} {} {} 0\n", x_m, y_m, z_m));
  window.wait_for_pixels(500, 100'000);
  CHECK(sphere_pixels() < uncovered / 10);
}

TEST_CASE("an unmoved object needs no frames, and a moved object redraws the scene") {
  ObjectWindow window;
  window.place("object 0 0 0 0\n");
  window.wait_for_pixels(2000, 100'000);
  const auto drawn_part = [&window] { return window.rig().look().all.at("drawn_part").get<double>(); };
  window.rig().control.run(0.05);  // the arm is stationary afterwards
  double least = 1.0;
  for (int i = 0; i < 20; ++i) least = std::min(least, drawn_part());
  CHECK(least < 0.1);
  // The window may draw the new placement before the question arrives, so the object moves several times.
  double most = 0.0;
  for (int i = 0; i < 200 && most < 0.2; ++i) {
    window.place(i % 2 == 0 ? "object 0 0.02 0 0\n" : "object 0 0 0 0\n");
    most = std::max(most, drawn_part());
  }
  CHECK(most > 0.2);
}

TEST_CASE("contact points have markers") {
  ObjectWindow window;
  window.place("object 0 0 0 0\n");
  window.wait_for_pixels(2000, 100'000);
  CHECK_FALSE(window.rig().look().has("scene/contact point"));
  window.place("object 0 0 0 0\ncontact 0 0.025 0\n");
  const Sight sight =
      window.rig().wait_until("the marker is there", [](const Sight& now) { return now.has("scene/contact point"); });
  const Item marker = sight.item("scene/contact point");
  const Colour pixel =
      window.rig().picture().at(static_cast<std::size_t>(marker.x), static_cast<std::size_t>(marker.y));
  CHECK(std::abs(pixel.red - colours::wall_touched.red) <= exactly);
  CHECK(std::abs(pixel.green - colours::wall_touched.green) <= exactly);
}

TEST_CASE("the command feel shows its object in the window") {
  WindowRig rig({"--flat-colours", "feel", "--example", "ball"});
  rig.move_to({700, 60});
  rig.wait_until("the ball is drawn", [&](const Sight&) { return ObjectWindow::object_pixels(rig.picture()) > 2000; });
  CHECK_FALSE(rig.look().says("loading"));
}

TEST_CASE("the window shows the progress of the loading, and a banner for an object that cannot be used") {
  ObjectWindow window;
  const auto wait_for = [&window](const std::string& said) {
    window.rig().wait_until(said, [&](const Sight& now) { return now.says(said); });
  };
  window.place("progress loading skull.stl: reading the mesh, 12 %\n");
  wait_for("loading skull.stl: reading the mesh, 12 %");
  window.place("progress loading skull.stl: building the search tree, 73 %\n");
  wait_for("building the search tree, 73 %");
  window.place("object 0 0 0 0\n");
  window.wait_for_pixels(2000, 100'000);
  CHECK_FALSE(window.rig().look().says("loading"));
  CHECK_FALSE(window.rig().look().says("The object cannot be used."));
  window.place("problem skull.stl is empty. Export the object again.\n");
  wait_for("The object cannot be used.");
  wait_for("skull.stl is empty. Export the object again. Then start the program again.");
}

TEST_CASE("the view contains objects outside the box, until the user has moved the view") {
  ObjectWindow window;
  const Item box_only = window.rig().look().item("scene/sphere");
  window.place("object 0 0.4 0 0\n");
  window.wait_for_pixels(100, 100'000);
  const Image image = window.rig().picture();
  CHECK(middle_of_object(image).y > 60);  // below the status bar
  const Item fitted = window.rig().look().item("scene/sphere");
  CHECK(std::abs(fitted.y - box_only.y) > 10);
}

TEST_CASE("a mesh of 300,000 triangles is drawn after its preparation, and the window does not wait for it") {
  ObjectWindow window({"--flat-colours", "--ball", "7"});
  window.place("object 0 0 0 0\n");
  window.wait_for_pixels(2000, 100'000);
  CHECK_FALSE(window.rig().look().says("Preparing the picture"));
}
