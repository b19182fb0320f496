// Forces and shapes of a user program.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "protocol/reports.hpp"

namespace inkwell::device {

/// protocol::ForceReport describes the effect of this request.
struct ForceRequest {
  std::array<float, 3> force_N{};  ///< on the hand, in workspace axes
  protocol::ForceMode mode = protocol::ForceMode::beside_walls;
  int interval_ms = 1;  ///< time until the next request, 1 to protocol::force_interval_maximum_ms
  /// Sequence number of the pose for which the force was computed. By default, this is the newest pose.
  std::optional<std::uint32_t> pose_sequence{};
};

/// Surface properties of a shape. protocol::SurfaceEntry contains the ranges.
struct Surface {
  float stiffness_N_per_m = 800.0f;
  float damping_Ns_per_m = 2.0f;
  float static_friction = 0.0f;   ///< largest ratio of tangential force to normal force while the probe sticks
  float dynamic_friction = 0.0f;  ///< ratio of tangential force to normal force while the probe slides
  /// The board removes the shape after this time unless the program places the shape again. By default, the shape
  /// exists while the program drives the arm.
  float life_s = std::numeric_limits<float>::infinity();
};

/// The probe is a point for this wall.
struct Plane {
  std::array<float, 3> point_m{};                 ///< any point on the plane
  std::array<float, 3> normal{0.0f, 0.0f, 1.0f};  ///< points into the free space, with any length except 0
  Surface surface;
};

/// The probe stays outside the sphere.
struct Sphere {
  std::array<float, 3> centre_m{};
  float radius_m = 0.02f;
  Surface surface;
};

/// If a shape moves and stays in its slot, its friction contact with the probe remains.
struct Shapes {
  std::array<std::optional<Plane>, protocol::shape_planes_maximum> planes;
  std::optional<Sphere> sphere;
};

/// Creates the report for the board. Throws Error with the value and its range if the board would refuse the value.
protocol::ForceReport force_report(const ForceRequest& request);
protocol::ShapesReport shapes_report(const Shapes& shapes);

}  // namespace inkwell::device
