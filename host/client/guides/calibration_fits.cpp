#include "host/client/guides/calibration_fits.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "host/client/device/error.hpp"

namespace inkwell::guides {

StopsFit fit_stops(const JointStops& found, const JointStops& expected, double old_inkwell_rad, bool fit_scale) {
  StopsFit fit{1, old_inkwell_rad, found.low_rad - expected.low_rad, found.high_rad - expected.high_rad};
  if (fit_scale) fit.scale = expected.width_rad() / found.width_rad();
  const double low_rad = old_inkwell_rad + fit.scale * (found.low_rad - old_inkwell_rad);
  const double high_rad = old_inkwell_rad + fit.scale * (found.high_rad - old_inkwell_rad);
  fit.inkwell_rad += ((expected.low_rad - low_rad) + (expected.high_rad - high_rad)) / 2;
  return fit;
}

double PotentiometerCurve::ratio(double angle_rad) const {
  const double constant = offset_rad - angle_rad;
  const double discriminant = std::max(slope_rad * slope_rad - 4 * square_rad * constant, 0.0);
  // This form of the root converges to the linear solution as the square term vanishes.
  const double divisor = slope_rad + std::copysign(std::sqrt(discriminant), slope_rad);
  if (divisor == 0)
    throw device::Error("The potentiometer's slope is 0, so nothing can be read from it. Load the defaults.");
  return -2 * constant / divisor;
}

PotentiometerCurve fit_potentiometer(std::span<const PotentiometerPoint> points, bool quadratic) {
  const Eigen::Index unknowns = quadratic ? 3 : 2;
  if (static_cast<Eigen::Index>(points.size()) < unknowns)
    throw device::Error("There are too few points for the potentiometer's curve. Start the guide again.");
  constexpr double smallest_spread = 0.1;
  const auto [least, most] = std::ranges::minmax_element(points, {}, &PotentiometerPoint::ratio);
  if (most->ratio - least->ratio < smallest_spread)
    throw device::Error(
        "The potentiometer's voltage hardly changed. Check its plug and turn the axis to both its stops.");
  Eigen::MatrixXd powers(static_cast<Eigen::Index>(points.size()), unknowns);
  Eigen::VectorXd angles(powers.rows());
  for (Eigen::Index i = 0; i < powers.rows(); ++i) {
    const auto& point = points[static_cast<std::size_t>(i)];
    powers(i, 0) = 1;
    powers(i, 1) = point.ratio;
    if (quadratic) powers(i, 2) = point.ratio * point.ratio;
    angles[i] = point.angle_rad;
  }
  const auto decomposition = powers.colPivHouseholderQr();
  if (decomposition.rank() < unknowns)
    throw device::Error("Two points of the potentiometer are the same. Hold the axis in the middle for the third one.");
  const Eigen::VectorXd fitted = decomposition.solve(angles);
  return {quadratic ? fitted[2] : 0.0, fitted[1], fitted[0]};
}

}  // namespace inkwell::guides
