// What joint stops and ends of potentiometers say about the arm's parameters. Pure: angles in, numbers out.
#pragma once

#include <span>

namespace inkwell::guides {

/// Angles of one joint at its two stops.
struct JointStops {
  double low_rad;
  double high_rad;
  double width_rad() const { return high_rad - low_rad; }
};

/// How the joint's angles must change so that its stops are found where they are expected:
/// right angle = inkwell_rad + scale (angle - old inkwell angle).
struct StopsFit {
  double scale;                          ///< 1 if the found travel is as wide as the expected one
  double inkwell_rad;                    ///< the inkwell's angle that goes with the scale
  double low_error_rad, high_error_rad;  ///< found less expected, as the angles are now
};

/// Stops yield under the hand and counts are whole, so differences up to this mean nothing.
inline constexpr double stops_tolerance_rad = 0.03;

/// With `fit_scale` the scale and the inkwell's angle are found, else only the angle (scale 1). `expected` has a width.
StopsFit fit_stops(const JointStops& found, const JointStops& expected, double old_inkwell_rad, bool fit_scale);

/// angle = square r^2 + slope r + offset, r the wiper's voltage as a part of its supply, 0..1.
struct PotentiometerCurve {
  double square_rad = 0;
  double slope_rad = 0;
  double offset_rad = 0;

  double angle_rad(double ratio) const { return (square_rad * ratio + slope_rad) * ratio + offset_rad; }
  /// The inverse on the branch that the slope's sign chooses. Throws device::Error if the curve is flat.
  double ratio(double angle_rad) const;
};

struct PotentiometerPoint {
  double ratio;
  double angle_rad;
};

/// Least squares through the points; a quadratic needs three, a line two. Throws device::Error if there are too few or
/// their ratios lie so close together that the curve would be arbitrary.
PotentiometerCurve fit_potentiometer(std::span<const PotentiometerPoint> points, bool quadratic);

}  // namespace inkwell::guides
