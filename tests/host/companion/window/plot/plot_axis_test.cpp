#include <cmath>
#include <utility>

#include <doctest/doctest.h>

#include "host/companion/window/plot/plot_axis.hpp"

using namespace inkwell::window;

TEST_CASE("ticks are round numbers inside the range") {
  const auto result = ticks({-0.23, 0.98}, 6);
  REQUIRE(result.size() == 6);
  CHECK(result.front() == doctest::Approx(-0.2));
  CHECK(result.back() == doctest::Approx(0.8));
  CHECK(ticks({1.0, 1.0}, 5).empty());
  CHECK(tick_label(0.25, 0.05) == "0.25");
  CHECK(tick_label(1500.0, 500.0) == "1500");
  CHECK(tick_label(1e-17, 0.5) == "0");
}

TEST_CASE("a range holds its data, also if they are constant or missing") {
  for (const auto& [low, high] : {std::pair{0.0, 3.3}, {-1e-5, 1e-5}, {42.0, 42.0}, {-7e4, 2.0}}) {
    const AxisRange range = enclosing_range(low, high);
    CHECK(range.minimum <= low);
    CHECK(range.maximum >= high);
    CHECK(range.extent() > 0.0);
    CHECK(range.extent() < 2.0 * std::max(high - low, 0.2 * std::abs(low)));
  }
}

TEST_CASE("an axis around zero shows a usual range of its unit") {
  for (const double none : {0.0, std::nan("")}) {
    const AxisRange range = enclosing_range(none, none, extent_around_zero("m"));
    CHECK(range.minimum == doctest::Approx(-0.01));
    CHECK(range.maximum == doctest::Approx(0.01));
  }
  CHECK(extent_around_zero("N") == 2.0);
  CHECK(extent_around_zero("furlong") == 2.0);
  CHECK(SteadyRange(0.1).update(0.0, 0.0, 0.0).extent() == doctest::Approx(0.1));
}

TEST_CASE("an axis grows at once and shrinks only after a while") {
  SteadyRange axis;
  axis.update(0.0, 1.0, 0.0);
  CHECK(axis.update(0.0, 10.0, 0.1).maximum >= 10.0);
  CHECK(axis.update(0.0, 1.0, 0.2).maximum >= 10.0);
  CHECK(axis.update(0.0, 1.0, 1.0).maximum >= 10.0);
  CHECK(axis.update(0.0, 1.0, 2.0).maximum < 2.0);
}

TEST_CASE("the range around a constant is reduced at the first change") {
  SteadyRange axis;
  axis.update(0.0, 0.0, 0.0);
  CHECK(axis.update(0.0, 0.003, 0.1).extent() < 0.01);
}
