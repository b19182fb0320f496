#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/control/signal_path/trigonometry.hpp"

namespace {

using namespace inkwell::control;

TEST_CASE("sine and cosine have an error of at most 1.2e-7 over twenty radians in both directions") {
#ifdef INKWELL_ON_PC
  constexpr int steps = 2'000'000;
#else
  constexpr int steps = 1'000;
#endif
  double worst = 0;
  for (int i = -steps; i <= steps; ++i) {
    const float angle = 20.0f * static_cast<float>(i) / static_cast<float>(steps);
    const SineCosine result = sine_cosine(angle);
    worst = std::max({worst, std::abs(result.sine - std::sin(static_cast<double>(angle))),
                      std::abs(result.cosine - std::cos(static_cast<double>(angle)))});
  }
  MESSAGE("worst error " << worst);
  CHECK(worst < 1.2e-7);
}

TEST_CASE("sine and cosine at the ends of the quadrants") {
  CHECK(sine_cosine(0.0f).sine == 0.0f);
  CHECK(sine_cosine(0.0f).cosine == 1.0f);
  CHECK(sine_cosine(1.5707964f).sine == 1.0f);
  CHECK(std::abs(sine_cosine(1.5707964f).cosine) < 1e-7f);
  CHECK(sine_cosine(-1.5707964f).sine == -1.0f);
  CHECK(sine_cosine(3.1415927f).cosine == -1.0f);
}

TEST_CASE("reciprocals by Newton's method") {
  double worst_reciprocal = 0, worst_root = 0;
  for (float value = 1e-12f; value < 1e12f; value *= 1.0173f) {
    worst_reciprocal = std::max(worst_reciprocal, std::abs(reciprocal(value) * static_cast<double>(value) - 1.0));
    worst_root =
        std::max(worst_root, std::abs(reciprocal_square_root(value) * std::sqrt(static_cast<double>(value)) - 1.0));
  }
  CHECK(worst_reciprocal < 2e-7);
  CHECK(worst_root < 3e-7);
}

TEST_CASE("is_finite returns true for finite numbers and false for infinities and NaN") {
  using limits = std::numeric_limits<float>;
  CHECK(is_finite(0.0f));
  CHECK(is_finite(limits::max()));
  CHECK(is_finite(-limits::denorm_min()));
  CHECK_FALSE(is_finite(limits::infinity()));
  CHECK_FALSE(is_finite(-limits::infinity()));
  CHECK_FALSE(is_finite(limits::quiet_NaN()));
}

}  // namespace
