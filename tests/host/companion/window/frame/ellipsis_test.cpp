// Tests the shortening of long labels.
#include <doctest/doctest.h>

#include "host/companion/window/frame/ellipsis.hpp"

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

TEST_CASE("a shortened label keeps the number at its end if the number fits") {
  CHECK(with_ellipsis("Motor resistance 1", 14, characters) == "Motor resis\u2026 1");
  CHECK(with_ellipsis("Motor resistance 12", 8, characters) == "Moto\u2026 12");
  CHECK(with_ellipsis("Motor resistance 1", 3, characters) == "Mo\u2026");
  CHECK(with_ellipsis("Figure12", 6, characters) == "Figur\u2026");
}
