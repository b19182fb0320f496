// What a program of the user wants the hand to feel: forces, and shapes that the board renders at its full servo rate.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include <protocol/reports.hpp>

namespace inkwell::device {

/// A force for the program's next interval (protocol::ForceReport says what the board makes of it).
struct ForceRequest {
  std::array<float, 3> force_N{};  ///< on the hand, workspace axes
  protocol::ForceMode mode = protocol::ForceMode::beside_walls;
  int interval_ms = 1;  ///< until the program sends the next one, 1 to protocol::force_interval_maximum_ms
  /// Of the pose that it answers; the newest one if none is given.
  std::optional<std::uint32_t> pose_sequence{};
};

/// How a shape feels; ranges as in protocol::SurfaceEntry.
struct Surface {
  float stiffness_N_per_m = 800.0f;
  float damping_Ns_per_m = 2.0f;
  float static_friction = 0.0f;   ///< bound of the tangential force while it sticks, as a part of the normal force
  float dynamic_friction = 0.0f;  ///< the same while it slides
  /// Then the board forgets the shape, unless it is placed again. By default it lasts as long as the program drives.
  float life_s = std::numeric_limits<float>::infinity();
};

/// A wall for the probe, which is a point to it.
struct Plane {
  std::array<float, 3> point_m{};                 ///< any point of it
  std::array<float, 3> normal{0.0f, 0.0f, 1.0f};  ///< into the free space, of any length but 0
  Surface surface;
};

/// An obstacle; the free space is outside.
struct Sphere {
  std::array<float, 3> centre_m{};
  float radius_m = 0.02f;
  Surface surface;
};

/// The shapes from now on. A shape that keeps its place keeps its friction's grip while it moves.
struct Shapes {
  std::array<std::optional<Plane>, protocol::shape_planes_maximum> planes;
  std::optional<Sphere> sphere;
};

/// As it goes over the wire. Throws Error naming the value that the board would refuse, and its range.
protocol::ForceReport force_report(const ForceRequest& request);
protocol::ShapesReport shapes_report(const Shapes& shapes);

}  // namespace inkwell::device
