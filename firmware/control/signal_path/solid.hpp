// Solids that the tip cannot enter: sphere, capsule, cylinder, box.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

/// A point x is in the free space if normal * x > offset.
struct Plane {
  Vector3 normal;  ///< unit vector
  float offset_m;
};

/// A shape is near if its distance from the proxy is smaller. Other shapes are examined in turn: until the next
/// examination, at most 50 periods later, a proxy at 2 m/s moves by 5 mm. A proxy that loses its support moves at most
/// by the depth of the probe.
constexpr float near_margin_m(float depth_m) { return 0.006f + 2.0f * depth_m; }

/// Distances from a core below 0.1 um give no reliable direction.
inline constexpr float smallest_squared_m2 = 1e-14f;

/// All points within `radius_m` of a core. The core of a sphere is its center. The core of a capsule is a segment. The
/// core of a rounded box is a smaller box, and the core of a rounded cylinder is a smaller cylinder.
struct Solid {
  enum class Core : std::uint32_t { nothing, point, segment, cylinder, box };

  Core core = Core::nothing;
  Vector3 centre_m;
  /// Unit vectors: the axis of a segment or cylinder, the edges of a box.
  std::array<Vector3, 3> axes{};
  std::array<float, 3> half_m{};  ///< half lengths of the core along the axes
  float core_radius_m = 0.0f;     ///< of the core of a cylinder
  float radius_m = 0.0f;          ///< radius, or rounding of the edges
};

/// Relation of a point to the surface of a solid.
struct Foot {
  Vector3 normal;  ///< unit vector, outward
  float height_m;  ///< distance from the surface, negative inside
};

/// Returns false if the solid has no normal at the point, because the point is in the core.
bool find_foot(const Solid& solid, const Vector3& point_m, Foot& foot);

/// Sets the tangent plane at the foot of a point. Returns false if the point is farther than `margin_m` from the solid,
/// or in the core.
bool find_tangent(const Solid& solid, const Vector3& point_m, float margin_m, Plane& tangent);

}  // namespace inkwell::control
