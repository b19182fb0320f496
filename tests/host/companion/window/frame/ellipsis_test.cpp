// Tests the shortening of long labels and the window size for a text.
#include <doctest/doctest.h>

#include "host/companion/window/frame/ellipsis.hpp"
#include "host/companion/window/frame/window_size.hpp"

using namespace inkwell::window;

namespace {

/// Returns the number of characters as the text width.
float characters(std::string_view text) {
  float count = 0;
  for (const char byte : text) count += (static_cast<unsigned char>(byte) & 0xC0u) != 0x80u ? 1.0f : 0.0f;
  return count;
}

}  // namespace

TEST_CASE("a label that does not fit ends in an ellipsis, between two characters") {
  CHECK(with_ellipsis("Wall stiffness", 14, characters) == "Wall stiffness");
  CHECK(with_ellipsis("Wall stiffness", 13, characters) == "Wall stiffne\u2026");
  CHECK(with_ellipsis("Wall stiffness", 6, characters) == "Wall\u2026");  // no space before it
  CHECK(with_ellipsis("\u03a9\u03a9\u03a9", 2, characters) == "\u03a9\u2026");
  CHECK(with_ellipsis("Wall", 1, characters).empty());
  CHECK(with_ellipsis("", 1, characters).empty());
}

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
