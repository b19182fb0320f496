// Planes and solids of a program. A program places them rarely, and the board renders them at the full servo rate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/solid.hpp"
#include "firmware/control/signal_path/surface.hpp"
#include "firmware/control/signal_path/vector.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

/// Set of shapes, prepared outside the interrupt. Shapes 0 to 7 are the planes, and the other shapes are the solids.
struct Shapes {
  static constexpr std::size_t planes_maximum = protocol::shape_planes_maximum;
  /// The sphere of a ShapesReport is the last solid.
  static constexpr std::size_t solids_maximum = protocol::shape_solids_maximum + 1;
  static constexpr std::size_t maximum = planes_maximum + solids_maximum;
  static constexpr std::uint32_t all_planes = (1u << planes_maximum) - 1u;
  /// Value of `life_periods` for a shape that does not expire.
  static constexpr std::uint32_t lasting = 0xFFFFFFFFu;

  /// The planes, and then the tangent planes of the solids.
  std::array<Plane, maximum> planes{};
  std::array<Solid, solids_maximum> solids{};
  std::array<Surface, maximum> surfaces{};
  /// Life of each shape; 0 for an unused shape.
  std::array<std::uint32_t, maximum> life_periods{};
  std::uint32_t used = 0;  ///< one bit per shape number
  std::uint32_t near = 0;  ///< one bit per shape within the margin of the proxy
};

/// Renews the tangent plane of a shape. Returns true if the shape is within `margin_m` of the proxy.
inline bool renew_tangent(Shapes& shapes, std::size_t number, const Vector3& proxy_m, float margin_m) {
  Plane& plane = shapes.planes[number];
  if (number >= Shapes::planes_maximum)
    return find_tangent(shapes.solids[number - Shapes::planes_maximum], proxy_m, margin_m, plane);
  return dot(plane.normal, proxy_m) - plane.offset_m < margin_m;
}

/// Sets `used`, `near` and the tangent planes of a new set from its other members. `depth_m` is the depth of the probe
/// in the present surfaces. This function is inline, because code of the main loop must not be in the interrupt memory.
inline void find_tangents(Shapes& shapes, const Vector3& proxy_m, float depth_m = 0.0f) {
  shapes.used = 0;
  shapes.near = 0;
  for (std::size_t i = 0; i < Shapes::maximum; ++i) {
    if (shapes.life_periods[i] == 0) continue;
    shapes.used |= 1u << i;
    if (renew_tangent(shapes, i, proxy_m, near_margin_m(depth_m))) shapes.near |= 1u << i;
  }
}

/// Shapes that have not expired.
class LivingShapes {
 public:
  /// Activates a new set. The board changes the set until the next call.
  void replace(Shapes& shapes);

  /// Advances by one period. Returns true if a shape has expired. A shape ends at most 25 periods after its life.
  bool age();

  /// Examines a shape: in turn a solid near the proxy, whose tangent plane is renewed, and one of the other shapes.
  void examine(const Vector3& proxy_m, float margin_m);
  /// Examines a shape. Returns true if the shape is near the proxy.
  bool renew(std::size_t number, const Vector3& proxy_m, float margin_m);
  /// The shape is near again when it is examined in turn.
  void forget(std::size_t number) { near_ &= ~(1u << number); }

  bool any() const { return living_ != 0; }
  /// Shapes near the proxy, one bit per shape number.
  std::uint32_t near() const { return near_; }
  const Plane& plane(std::size_t number) const { return shapes_->planes[number]; }
  const Surface& surface(std::size_t number) const { return shapes_->surfaces[number]; }

 private:
  void examine_next(std::uint32_t& above, std::uint32_t among, const Vector3& proxy_m, float margin_m);

  Shapes* shapes_ = nullptr;
  std::uint32_t age_periods_ = 0;
  std::uint32_t living_ = 0;       ///< one bit per shape number
  std::uint32_t near_ = 0;         ///< living shapes near the proxy
  std::uint32_t above_solid_ = 0;  ///< one bit per shape above the near solid that was examined last
  std::uint32_t above_ = 0;        ///< the same for the other shapes
  bool is_turn_of_near_solids_ = false;
  std::uint32_t aged_ = 0;  ///< number of the shape whose life was examined last
};

static_assert(Shapes::maximum <= 32, "LivingShapes has one bit per shape");

}  // namespace inkwell::control
