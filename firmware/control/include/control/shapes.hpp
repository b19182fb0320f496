// Local models: planes and a sphere that a program on the PC places where its scene is near, felt at the full servo
// rate (Adachi, Kumano, Ogino, "Intermediate representation for stiff virtual objects", VRAIS 1995).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <control/vector.hpp>
#include <protocol/reports.hpp>

namespace inkwell::control {

/// How a shape feels. The probe is a point to it.
struct Surface {
  float stiffness_N_per_m;
  float m_per_N;  ///< 1 / stiffness
  float damping_Ns_per_m;
  float static_friction;   ///< bound of the tangential force while it sticks, as a part of the normal force
  float dynamic_friction;  ///< the same while it slides; not above the static one
};

/// The free space is where normal * x > offset.
struct Plane {
  Vector3 normal;  ///< of length 1
  float offset_m;
};

/// The free space is outside.
struct Sphere {
  Vector3 centre_m;
  float radius_m;
  float radius_squared_m2;
};

/// A set of shapes, prepared outside of the interrupt. Shape 0 is the sphere, 1 to 8 are the planes.
struct Shapes {
  static constexpr std::size_t maximum = 1 + protocol::shape_planes_maximum;
  /// The life of a shape that has no end of its own.
  static constexpr std::uint32_t lasting = 0xFFFFFFFFu;

  Sphere sphere{};
  std::array<Plane, protocol::shape_planes_maximum> planes{};
  std::array<Surface, maximum> surfaces{};
  std::array<std::uint32_t, maximum> life_periods{};  ///< from when the set takes effect; 0 for a shape that is not
};

/// Where the probe holds on to a shape that it touches.
struct Grip {
  Vector3 point_m;
  bool slides = false;
};

/// The normal spring and damper, which never pull, and friction that sticks and slides (Salisbury et al., "Haptic
/// rendering: programming touch interaction with virtual objects", I3D 1995). `depth_m`: of the probe behind the
/// surface; `is_new`: it was not behind it in the period before, so it takes hold where it is.
Vector3 surface_force_N(const Surface& surface, const Vector3& normal, float depth_m, const Vector3& probe_m,
                        const Vector3& velocity_m_per_s, Grip& grip, bool is_new);

/// The shapes as they are felt from period to period.
class TouchedShapes {
 public:
  /// A new set takes effect; `shapes` must stay as it is until the next one. Shapes that were and are there keep their
  /// grip.
  void replace(const Shapes& shapes);

  /// One period further: true if a shape's life has ended.
  bool age();

  Vector3 force_N(const Vector3& probe_m, const Vector3& velocity_m_per_s);

  bool any() const { return sphere_lives_ || any_plane_lives_; }

 private:
  [[gnu::cold]] void list_alive();

  const Shapes* shapes_ = nullptr;
  std::uint32_t age_periods_ = 0;
  std::uint32_t next_end_periods_ = 0;  ///< age at which the next life ends; 0 for none
  bool sphere_lives_ = false;
  bool any_plane_lives_ = false;
  std::array<Plane, protocol::shape_planes_maximum> planes_{};  ///< one that does not live lies out of reach
  std::array<Grip, Shapes::maximum> grips_{};                   ///< by the shape's number
  std::uint32_t touched_ = 0;                                   ///< in the period before; bit of the shape's number
};

}  // namespace inkwell::control
