#include <doctest/doctest.h>

#include <random>
#include <vector>

#include "host/client/device/error.hpp"
#include "host/client/guides/calibration_fits.hpp"

using namespace inkwell::guides;

TEST_CASE("stops give back the scale and the inkwell's angle that were wrong") {
  const JointStops expected{-0.98, 0.98};
  const double inkwell_rad = 0.1;
  // The device's encoder scale is 1.25 times too large, and its inkwell angle is wrong by 0.05 rad.
  const auto shown = [&](double right_rad) { return inkwell_rad + (right_rad - 0.15) * 1.25; };
  const StopsFit fit = fit_stops({shown(-0.98), shown(0.98)}, expected, inkwell_rad, true);
  CHECK(fit.scale == doctest::Approx(0.8));
  CHECK(fit.inkwell_rad == doctest::Approx(0.15));
}

TEST_CASE("without a scale the error of both stops is shared") {
  const StopsFit fit = fit_stops({0.05, 1.83}, {0.0, 1.75}, 0.25, false);
  CHECK(fit.scale == 1);
  CHECK(fit.inkwell_rad == doctest::Approx(0.25 - 0.065));
  CHECK(fit.low_error_rad == doctest::Approx(0.05));
  CHECK(fit.high_error_rad == doctest::Approx(0.08));
}

TEST_CASE("a potentiometer's curve is found from noisy points") {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.0004);
  for (const PotentiometerCurve right : {PotentiometerCurve{0, 4.91, -2.455}, {0.4, 2.25, -0.5}, {-0.3, -5.16, 2.58}}) {
    std::vector<PotentiometerPoint> points;
    for (int i = 0; i <= 20; ++i) points.push_back({i / 20.0 + noise(random), right.angle_rad(i / 20.0)});
    const auto fitted = fit_potentiometer(points, right.square_rad != 0);
    CHECK(fitted.slope_rad == doctest::Approx(right.slope_rad).scale(0).epsilon(0.01));
    CHECK(fitted.offset_rad == doctest::Approx(right.offset_rad).scale(0).epsilon(0.01));
    CHECK(std::abs(fitted.square_rad - right.square_rad) < 0.02);
  }
}

TEST_CASE("the curve's inverse leads back") {
  for (const PotentiometerCurve curve : {PotentiometerCurve{0, 4.91, -2.455}, {0.4, 2.25, -0.5}, {-0.3, -5.16, 2.58}})
    for (double ratio = 0; ratio <= 1.0; ratio += 0.1)
      CHECK(curve.ratio(curve.angle_rad(ratio)) == doctest::Approx(ratio).epsilon(1e-9));
  CHECK_THROWS_AS(PotentiometerCurve{}.ratio(0.3), inkwell::device::Error);
}

TEST_CASE("a potentiometer that does not move, or too few points, is no calibration") {
  const std::vector<PotentiometerPoint> still{{0.5, -1}, {0.51, 1}};
  CHECK_THROWS_WITH_AS(fit_potentiometer(still, false), doctest::Contains("hardly changed"), inkwell::device::Error);
  const std::vector<PotentiometerPoint> two{{0.1, -1}, {0.9, 1}};
  CHECK_THROWS_AS(fit_potentiometer(two, true), inkwell::device::Error);
  const std::vector<PotentiometerPoint> twice{{0.1, -1}, {0.9, 1}, {0.9, 1}};
  CHECK_THROWS_WITH_AS(fit_potentiometer(twice, true), doctest::Contains("the same"), inkwell::device::Error);
}
