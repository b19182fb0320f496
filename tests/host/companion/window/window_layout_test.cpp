// Panes never overlap and share the window height proportionally.
#include <doctest/doctest.h>

#include <array>

#include "host/companion/window/window_layout.hpp"

using namespace inkwell::window;

namespace {

bool overlap(const Rectangle& a, const Rectangle& b) {
  const auto apart = [](float a_begin, float a_size, float b_begin, float b_size) {
    return a_begin + a_size <= b_begin + 0.01f || b_begin + b_size <= a_begin + 0.01f;
  };
  return !apart(a.origin.x, a.size.x, b.origin.x, b.size.x) && !apart(a.origin.y, a.size.y, b.origin.y, b.size.y);
}

}  // namespace

TEST_CASE("no part of the window overlaps another one or leaves the window") {
  for (const float scale : {1.0f, 2.0f})
    for (const ImVec2 points : {ImVec2{900, 560}, {1280, 800}, {1920, 1080}, {2560, 1440}, {3840, 2160}})
      for (const float part : {0.1f, 0.42f, 0.9f}) {
        CAPTURE(points.y);
        CAPTURE(part);
        const ImVec2 window{scale * points.x, scale * points.y};
        WindowSettings settings;
        settings.scope_part = part;
        const auto layout = layout_of(window, {100 * scale, 46 * scale}, settings, scale);
        const std::array parts{layout.status, layout.scene, layout.replay, layout.scope, layout.column};
        for (std::size_t i = 0; i < parts.size(); ++i) {
          CHECK(parts[i].origin.x + parts[i].size.x <= window.x + 0.5f);
          CHECK(parts[i].origin.y + parts[i].size.y <= window.y + 0.5f);
          for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(overlap(parts[i], parts[j]));
        }
        CHECK(layout.scope.size.y >= 0.99f * WindowSettings::scope_height_minimum * scale - 6 * scale);
        CHECK(layout.scene.size.y > 100 * scale);
      }
}

TEST_CASE("a banner covers the scene below its buttons and no other part") {
  const WindowSettings settings;
  for (const float scale : {1.0f, 2.0f}) {
    const auto layout = layout_of({900 * scale, 560 * scale}, {92 * scale, 0}, settings, scale);
    const Rectangle banner = layout.banner(60 * scale);
    CHECK(banner.size.y == 60 * scale);
    CHECK(banner.origin.x > layout.scene.origin.x);
    CHECK(banner.origin.x + banner.size.x < layout.scene.origin.x + layout.scene.size.x);
    CHECK(banner.origin.y >= layout.scene.origin.y + 40 * scale);
    CHECK(banner.origin.y + banner.size.y < layout.scene.origin.y + layout.scene.size.y);
  }
}

TEST_CASE("a higher window gives scene and scope more in proportion") {
  const WindowSettings settings;
  const auto scope_part = [&](float height) {
    const auto layout = layout_of({1280, height}, {46, 0}, settings, 1.0f);
    return layout.scope.size.y / (height - 46);
  };
  CHECK(scope_part(800) == doctest::Approx(settings.scope_part).scale(0).epsilon(0.02));
  CHECK(scope_part(1440) == doctest::Approx(settings.scope_part).scale(0).epsilon(0.02));
  CHECK(scope_part(2160) == doctest::Approx(settings.scope_part).scale(0).epsilon(0.02));
}

TEST_CASE("a drag moves the splitter with the mouse from its displayed position") {
  WindowSettings settings;
  settings.scope_part = 0.9f;  // more than the available height
  const ImVec2 window{1280, 800};
  const LayoutNeeds needs{46, 0};
  const auto before = layout_of(window, needs, settings, 1.0f);
  drag_scope_splitter(20, before, 1.0f, settings);
  const auto after = layout_of(window, needs, settings, 1.0f);
  CHECK(after.scope.origin.y - before.scope.origin.y == doctest::Approx(20).epsilon(0.06));
}

TEST_CASE("a window that is small for a while leaves the parts as they were") {
  WindowSettings settings;
  settings.column_width = 500;
  const WindowSettings before = settings;
  const auto small = layout_of({900, 560}, {46, 0}, settings, 1.0f);
  drag_column_splitter(0, {900, 560}, 1.0f, settings);
  drag_scope_splitter(0, small, 1.0f, settings);
  CHECK(settings.column_width == before.column_width);
  CHECK(settings.scope_part == before.scope_part);
}
