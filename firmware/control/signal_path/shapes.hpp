// Local models are planes and a sphere that approximate a program's scene near the probe. Local models are rendered at
// the full servo rate (Adachi, Kumano, Ogino, "Intermediate representation for stiff virtual objects", VRAIS 1995).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/vector.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

/// Surface properties of a shape. For shapes, the probe is a point.
struct Surface {
  float stiffness_N_per_m;
  float m_per_N;  ///< 1 / stiffness
  float damping_Ns_per_m;
  float static_friction;   ///< bound of the tangential force while sticking, as a part of the normal force
  float dynamic_friction;  ///< the same bound while sliding; not above static_friction
};

/// A point x is in the free space if normal * x > offset.
struct Plane {
  Vector3 normal;  ///< unit vector
  float offset_m;
};

/// The free space is outside the sphere.
struct Sphere {
  Vector3 centre_m;
  float radius_m;
  float radius_squared_m2;
};

/// Set of shapes, prepared outside the interrupt. Shape 0 is the sphere, and shapes 1 to 8 are the planes.
struct Shapes {
  static constexpr std::size_t maximum = 1 + protocol::shape_planes_maximum;
  /// Value of `life_periods` for a shape that does not expire.
  static constexpr std::uint32_t lasting = 0xFFFFFFFFu;

  Sphere sphere{};
  std::array<Plane, protocol::shape_planes_maximum> planes{};
  std::array<Surface, maximum> surfaces{};
  /// Life of each shape; 0 for an unused shape.
  std::array<std::uint32_t, maximum> life_periods{};
};

/// Grip point of the friction on a touched shape.
struct Grip {
  Vector3 point_m;
  bool slides = false;
};

/// Returns the sum of normal force and friction. The normal force comes from a spring and a damper and never pulls. The
/// friction is stick-slip friction (Salisbury et al., "Haptic rendering: programming touch interaction with virtual
/// objects", I3D 1995). `depth_m` is the depth of the probe below the surface. If `is_new` is true, the grip starts at
/// the probe.
Vector3 surface_force_N(const Surface& surface, const Vector3& normal, float depth_m, const Vector3& probe_m,
                        const Vector3& velocity_m_per_s, Grip& grip, bool is_new);

/// Shapes and their contact state.
class TouchedShapes {
 public:
  /// Activates a new set. `shapes` must not change until the next call. Shapes that exist in both sets retain their
  /// grip points.
  void replace(const Shapes& shapes);

  /// Advances by one period. Returns true if a shape has expired.
  bool age();

  Vector3 force_N(const Vector3& probe_m, const Vector3& velocity_m_per_s);

  bool any() const { return sphere_lives_ || any_plane_lives_; }

 private:
  [[gnu::cold]] void list_alive();

  const Shapes* shapes_ = nullptr;
  std::uint32_t age_periods_ = 0;
  std::uint32_t next_end_periods_ = 0;  ///< age of the next expiry; 0 for none
  bool sphere_lives_ = false;
  bool any_plane_lives_ = false;
  std::array<Plane, protocol::shape_planes_maximum> planes_{};  ///< an expired plane is outside the reach of the probe
  std::array<Grip, Shapes::maximum> grips_{};                   ///< indexed by shape number
  std::uint32_t touched_ = 0;  ///< shapes touched in the previous period, one bit per shape number
};

}  // namespace inkwell::control
