// Forces of a user program, and shapes that the board renders at its full servo rate.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "protocol/reports.hpp"

namespace inkwell::device {

/// A force for the program's next interval. protocol::ForceReport describes its effect.
struct ForceRequest {
  std::array<float, 3> force_N{};  ///< on the hand, workspace axes
  protocol::ForceMode mode = protocol::ForceMode::beside_walls;
  int interval_ms = 1;  ///< interval until the next request, 1 to protocol::force_interval_maximum_ms
  /// Sequence number of the answered pose. Default: the newest pose. Default: the newest pose.
  std::optional<std::uint32_t> pose_sequence{};
};

/// Surface properties of a shape; the ranges are in protocol::SurfaceEntry.
struct Surface {
  float stiffness_N_per_m = 800.0f;
  float damping_Ns_per_m = 2.0f;
  float static_friction = 0.0f;   ///< limit of the tangential force while the probe sticks, relative to the normal
                                  ///< force
  float dynamic_friction = 0.0f;  ///< the same while the probe slides
  /// The board removes the shape after this time, unless the shape is placed again. By default the shape exists while
  /// the program drives the arm.
  float life_s = std::numeric_limits<float>::infinity();
};

/// A wall, which treats the probe as a point.
struct Plane {
  std::array<float, 3> point_m{};                 ///< any point on the plane
  std::array<float, 3> normal{0.0f, 0.0f, 1.0f};  ///< direction into the free space, of any length except 0
  Surface surface;
};

/// An obstacle; the free space is outside.
struct Sphere {
  std::array<float, 3> centre_m{};
  float radius_m = 0.02f;
  Surface surface;
};

/// All current shapes. A moving shape in the same slot keeps its friction contact with the probe.
struct Shapes {
  std::array<std::optional<Plane>, protocol::shape_planes_maximum> planes;
  std::optional<Sphere> sphere;
};

/// These functions create the reports for the board. These functions throw Error if the board would refuse a value. The
/// error contains the value and its range.
protocol::ForceReport force_report(const ForceRequest& request);
protocol::ShapesReport shapes_report(const Shapes& shapes);

}  // namespace inkwell::device
