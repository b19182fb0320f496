// Tests the size and the scale of a new window on X11 and Wayland.
#include <doctest/doctest.h>

#include "host/companion/window/frame/window_size.hpp"

using namespace inkwell::window;

namespace {

constexpr ScreenSize points{1280, 800};

struct Fitted {
  ScreenSize size;
  float units_per_point;
};

Fitted fit(float content_scale, bool has_pixel_units, float wanted, std::optional<ScreenSize> room_pixels) {
  const auto fitted = fit_window(points, display_scale(content_scale, has_pixel_units), wanted, room_pixels);
  return {fitted.size, fitted.units_per_point};
}

}  // namespace

TEST_CASE("a window has the requested size in points, but is not larger than its display") {
  CHECK(window_size({1280, 800}, 1.0f, ScreenSize{1920, 1080}) == ScreenSize{1280, 800});
  CHECK(window_size({1280, 800}, 2.0f, ScreenSize{3840, 2160}) == ScreenSize{2560, 1600});
  CHECK(window_size({1280, 800}, 2.0f, ScreenSize{1920, 1080}) == ScreenSize{1920, 1080});
  CHECK(window_size({1280, 800}, 1.5f, std::nullopt) == ScreenSize{1920, 1200});
}

TEST_CASE("the text scale is reduced on a display that is too small for the window, but not below 1") {
  CHECK(fitting_scale(2.0f, ScreenSize{1920, 1200}) == 2.0f);
  CHECK(fitting_scale(2.0f, ScreenSize{1350, 840}) == doctest::Approx(1.5f));
  CHECK(fitting_scale(2.0f, ScreenSize{1800, 560}) == 1.0f);
  CHECK(fitting_scale(1.5f, ScreenSize{640, 480}) == 1.0f);
  CHECK(fitting_scale(2.0f, std::nullopt) == 2.0f);
}

TEST_CASE("on X11, a unit is a pixel, so size and scale follow the display") {
  for (const float scale : {1.0f, 1.25f, 2.0f}) {
    CAPTURE(scale);
    const auto fitted = fit(scale, true, 0, ScreenSize{3840, 2160});
    CHECK(fitted.units_per_point == scale);
    CHECK(fitted.size == window_size(points, scale, std::nullopt));
  }
  CHECK(fit(2, true, 1.5f, std::nullopt).units_per_point == 1.5f);
  CHECK(fit(0.5f, true, 0, std::nullopt).units_per_point == 1.0f);
  CHECK(fit(9, true, 0, std::nullopt).units_per_point == 4.0f);
}

TEST_CASE("a window that is resized between the queries of its two widths keeps its scale on X11") {
  CHECK(pixels_per_unit(1200, 1280, true) == 1.0f);
  CHECK(pixels_per_unit(1200, 2400, false) == 2.0f);
  CHECK(pixels_per_unit(0, 0, false) == 1.0f);  // a window that the desktop does not show
}

TEST_CASE("on Wayland, the desktop scales the units, so the window does not scale its contents a second time") {
  for (const float scale : {1.0f, 1.25f, 2.0f}) {
    CAPTURE(scale);
    const auto fitted = fit(scale, false, 0, ScreenSize{3840, 2160});
    CHECK(fitted.units_per_point == 1.0f);
    CHECK(fitted.size == points);
  }
  // The scale of the user is in pixels per point.
  CHECK(fit(2, false, 2, std::nullopt).units_per_point == 1.0f);
  CHECK(fit(2, false, 3, std::nullopt).units_per_point == 1.5f);
  CHECK(fit(1.25f, false, 2.5f, std::nullopt).size == ScreenSize{2560, 1600});
}

TEST_CASE("on Wayland, the area of the display is in pixels, and the window is not larger than this area") {
  CHECK(fit(2, false, 0, ScreenSize{1920, 1200}).size == ScreenSize{960, 600});
  CHECK(fit(1.25f, false, 0, ScreenSize{1920, 1080}).size == points);
  CHECK(fit(1.25f, false, 0, ScreenSize{1500, 1000}).size == ScreenSize{1200, 800});
  CHECK(fit_window(points, display_scale(2, false), 0, ScreenSize{1600, 1000}).smallest == ScreenSize{800, 500});
  CHECK(fit_window(points, display_scale(2, false), 0, std::nullopt).smallest == smallest_window_points);
}
