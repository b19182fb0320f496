// Computes arm parameters from joint stops and potentiometer end positions.
#pragma once

#include <span>

namespace inkwell::guides {

/// Angles of one joint at its two stops.
struct JointStops {
  double low_rad;
  double high_rad;
  double width_rad() const { return high_rad - low_rad; }
};

/// Correction of a joint's angles: corrected angle = inkwell_rad + scale (angle - old inkwell angle).
struct StopsFit {
  double scale;                          ///< 1 if the found travel equals the expected travel
  double inkwell_rad;                    ///< inkwell angle for this scale
  double low_error_rad, high_error_rad;  ///< found minus expected angle, before the correction
};

/// Tolerance for elastic stops and encoder resolution.
inline constexpr double stops_tolerance_rad = 0.03;

/// Fits the inkwell angle and, with `fit_scale`, the scale. Without `fit_scale` the scale is 1. `expected` must have a
/// nonzero width.
StopsFit fit_stops(const JointStops& found, const JointStops& expected, double old_inkwell_rad, bool fit_scale);

/// angle = square r^2 + slope r + offset, where r is the wiper voltage divided by its supply, 0..1.
struct PotentiometerCurve {
  double square_rad = 0;
  double slope_rad = 0;
  double offset_rad = 0;

  double angle_rad(double ratio) const { return (square_rad * ratio + slope_rad) * ratio + offset_rad; }
  /// Returns the ratio for an angle, on the branch given by the sign of the slope. Throws device::Error if the curve is
  /// flat.
  double ratio(double angle_rad) const;
};

struct PotentiometerPoint {
  double ratio;
  double angle_rad;
};

/// Least-squares fit; a quadratic curve needs at least three points, and a line needs at least two points. Throws
/// device::Error if there are too few points, or if their ratios are too close together for a meaningful curve.
PotentiometerCurve fit_potentiometer(std::span<const PotentiometerPoint> points, bool quadratic);

}  // namespace inkwell::guides
