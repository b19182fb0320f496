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

/// A point x is in the free space if normal * x > offset.
struct Plane {
  Vector3 normal;  ///< unit vector
  float offset_m;
};

/// Set of shapes, prepared outside the interrupt. Shapes 0 to 7 are the planes, and the other shapes are the solids.
struct Shapes {
  static constexpr std::size_t planes_maximum = protocol::shape_planes_maximum;
  /// The sphere of a ShapesReport is the last solid.
  static constexpr std::size_t solids_maximum = protocol::shape_solids_maximum + 1;
  static constexpr std::size_t maximum = planes_maximum + solids_maximum;
  /// Value of `life_periods` for a shape that does not expire.
  static constexpr std::uint32_t lasting = 0xFFFFFFFFu;

  std::array<Plane, planes_maximum> planes{};
  std::array<Solid, solids_maximum> solids{};
  std::array<Surface, maximum> surfaces{};
  /// Life of each shape; 0 for an unused shape.
  std::array<std::uint32_t, maximum> life_periods{};
};

/// Shapes that have not expired.
class LivingShapes {
 public:
  /// Activates a new set. `shapes` must not change until the next call.
  void replace(const Shapes& shapes);

  /// Advances by one period. Returns true if a shape has expired.
  bool age();

  bool any() const { return alive_ != 0; }
  /// One bit per living solid, bit 0 for the first solid.
  std::uint32_t solids() const { return alive_ >> Shapes::planes_maximum; }
  /// Every point is in the free space of an expired plane.
  const std::array<Plane, Shapes::planes_maximum>& planes() const { return planes_; }
  bool any_plane() const { return (alive_ & ((1u << Shapes::planes_maximum) - 1)) != 0; }
  const Solid& solid(std::size_t number) const { return shapes_->solids[number]; }
  const Surface& surface_of_plane(std::size_t number) const { return shapes_->surfaces[number]; }
  const Surface& surface_of_solid(std::size_t number) const {
    return shapes_->surfaces[Shapes::planes_maximum + number];
  }

 private:
  [[gnu::cold]] void list_alive();

  const Shapes* shapes_ = nullptr;
  std::uint32_t age_periods_ = 0;
  std::uint32_t next_end_periods_ = 0;  ///< age of the next expiry; 0 for none
  std::uint32_t alive_ = 0;             ///< one bit per shape number
  std::array<Plane, Shapes::planes_maximum> planes_{};
};

static_assert(Shapes::maximum <= 32, "LivingShapes has one bit per shape");

}  // namespace inkwell::control
