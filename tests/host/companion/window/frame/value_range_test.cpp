#include <doctest/doctest.h>

#include "host/companion/window/frame/value_range.hpp"

using inkwell::window::ValueRange;

TEST_CASE("a thousand points are the whole range, and a point is a step that suits it") {
  const ValueRange box{.minimum = -0.5f, .maximum = 0.5f, .decimals = 4};
  CHECK(box.dragged(-0.1f, 1) == doctest::Approx(-0.099f).epsilon(1e-6));
  CHECK(box.dragged(-0.5f, 1000) == 0.5f);
  CHECK(box.dragged(0.4f, 200) == 0.5f);
  CHECK(box.dragged(0.1f, -2000) == -0.5f);
  const ValueRange wide{.minimum = 0.1f, .maximum = 1000.0f, .decimals = 2, .logarithmic = true};
  CHECK(wide.dragged(1.0f, 250) == doctest::Approx(10.0f));
  CHECK(wide.dragged(10.0f, -250) == doctest::Approx(1.0f));
}

TEST_CASE("a drag rounds to the digits that are shown") {
  const ValueRange range{.minimum = 0, .maximum = 3000, .decimals = 0};
  CHECK(range.dragged(800, 0.5f) == 802.0f);  // 1.5 N/m further
  CHECK(range.text_of(802.0f) == "802");
  CHECK(ValueRange{.minimum = 0, .maximum = 1, .decimals = 3}.text_of(0.25f) == "0.250");
}

TEST_CASE("a value's position in its range, linear or by ratio") {
  const ValueRange linear{.minimum = 100, .maximum = 300, .decimals = 0};
  CHECK(linear.part_of(150) == doctest::Approx(0.25f));
  CHECK(linear.part_of(1000) == 1.0f);
  CHECK(linear.contains(300));
  CHECK_FALSE(linear.contains(300.5f));
  const ValueRange ratio{.minimum = 1, .maximum = 10000, .decimals = 0, .logarithmic = true};
  CHECK(ratio.part_of(100) == doctest::Approx(0.5f));
}
