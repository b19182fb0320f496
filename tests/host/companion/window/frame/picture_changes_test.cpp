// A change redraws the changed parts of a window and all parts above or below them.
#include <doctest/doctest.h>

#include <vector>

#include "host/companion/window/frame/picture_changes.hpp"

using namespace inkwell::window;

namespace {

constexpr Box window{0, 0, 1000, 800};
constexpr Box canvas{0, 50, 700, 500};
constexpr Box status{0, 0, 1000, 50}, plot{50, 520, 340, 780}, other_plot{380, 520, 690, 780},
    slider{720, 300, 980, 320};

/// The addresses identify panes.
constexpr int panes[3] = {};

DrawnPicture picture() {
  return {.window = window,
          .ground = 7,
          .canvas = canvas,
          .canvas_digest = 1,
          .panes = {{&panes[0], {{status, 1}}}, {&panes[1], {{plot, 2}, {other_plot, 3}}}, {&panes[2], {{slider, 4}}}}};
}

bool holds(const Box& box, const Box& part) { return enclosing(box, part) == box; }

}  // namespace

TEST_CASE("a picture without changes needs no drawing") { CHECK(changes_between(picture(), picture()).empty()); }

TEST_CASE("a part that has changed is drawn, and neither its pane nor the canvas with it") {
  DrawnPicture now = picture();
  now.panes[1].parts[0].digest = 20;
  const auto changes = changes_between(picture(), now);
  REQUIRE(changes.size() == 1);
  CHECK(holds(changes[0], plot));
  CHECK(changes[0].area() < 1.05f * plot.area());
}

TEST_CASE("a window whose framebuffer had another size is drawn completely, even if its layout is the same") {
  DrawnPicture wider = picture(), higher = picture();
  wider.width_pixels = 1200;
  higher.height_pixels = 700;
  for (const DrawnPicture& now : {wider, higher}) {
    CHECK(now != picture());
    CHECK(changes_between(picture(), now) == std::vector<Box>{window});
  }
}

TEST_CASE("where something was that has moved or gone is drawn as well") {
  DrawnPicture now = picture();
  const Box moved{720, 340, 980, 360};
  now.panes[2].parts[0].box = moved;
  auto changes = changes_between(picture(), now);
  REQUIRE(changes.size() == 1);
  CHECK(holds(changes[0], slider));
  CHECK(holds(changes[0], moved));

  now.panes[2].parts.clear();
  changes = changes_between(picture(), now);
  REQUIRE(changes.size() == 1);
  CHECK(holds(changes[0], slider));
}

TEST_CASE("the canvas is drawn as a whole: when it changes, and when something over it does") {
  DrawnPicture now = picture();
  now.canvas_digest = 10;
  CHECK(changes_between(picture(), now) == std::vector{canvas});

  now = picture();
  now.panes[2].parts.push_back({{600, 100, 800, 200}, 5});
  const auto changes = changes_between(picture(), now);
  REQUIRE(changes.size() == 1);
  CHECK(holds(changes[0], canvas));
  CHECK(changes[0].right < 810);
}

TEST_CASE("boxes have nothing in common, so that nothing see-through is drawn twice") {
  DrawnPicture now = picture();
  now.canvas_digest = 10;
  now.panes[0].parts[0].digest = 10;
  now.panes[1].parts[1].digest = 30;
  now.panes[2].parts.push_back({{500, 30, 990, 60}, 5});
  const auto changes = changes_between(picture(), now);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CHECK((common(changes[i], canvas).is_empty() || holds(changes[i], canvas)));
    for (std::size_t j = 0; j < i; ++j) CHECK(common(changes[i], changes[j]).is_empty());
  }
}

TEST_CASE("another size, theme or order of the panes changes all") {
  const auto whole = std::vector{window};
  for (const auto& change :
       {+[](DrawnPicture& of) {
          of.canvas = {0, 50, 690, 500};
        },
        +[](DrawnPicture& of) { of.ground = 8; }, +[](DrawnPicture& of) { std::swap(of.panes[0], of.panes[1]); },
        +[](DrawnPicture& of) { of.panes.pop_back(); }}) {
    DrawnPicture now = picture();
    change(now);
    CHECK(changes_between(picture(), now) == whole);
  }
}
