// Objects that the hand can touch.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "host/geometry/surface.hpp"

namespace inkwell::contact {

struct Material {
  float stiffness_N_per_m = 500;
  float damping_Ns_per_m = 0;
  float static_friction = 0;
  float dynamic_friction = 0;
  float viscosity_Ns_per_m = 0;

  bool operator==(const Material&) const = default;
};

inline constexpr std::size_t materials_max = 16;
/// Largest count of objects in a scene. The tool stores the placement of each object.
inline constexpr std::size_t objects_max = 64;

// Solids in the frame of their object, felt from outside. Lengths are positive.

/// Around the origin.
struct Sphere {
  double radius_m;
};

/// Around the origin, with edges along the axes.
struct Box {
  glm::dvec3 half_size_m;
};

/// Along z, from -half_length_m to half_length_m.
struct Cylinder {
  double radius_m, half_length_m;
};

/// Along z: all points within radius_m of the segment from -half_length_m to half_length_m.
struct Capsule {
  double radius_m, half_length_m;
};

/// The half-space below z = 0.
struct Plane {};

using Shape = std::variant<std::shared_ptr<const geometry::Surface>, Sphere, Box, Cylinder, Capsule, Plane>;

/// Position of the object's origin, and rotation from the object's frame into the workspace. The rotation is a unit
/// quaternion. A mesh has the frame of its source file.
struct Placement {
  glm::dvec3 position_m{};
  glm::dquat rotation{1, 0, 0, 0};

  glm::dvec3 to_workspace(const glm::dvec3& point_m) const { return position_m + rotation * point_m; }
  glm::dvec3 to_object(const glm::dvec3& point_m) const { return glm::conjugate(rotation) * (point_m - position_m); }
  bool operator==(const Placement&) const = default;
};

struct Object {
  std::uint32_t id = 0;  ///< unique in the scene
  Shape shape;
  Placement placement;
  glm::dvec3 velocity_m_per_s{};  ///< of the object's origin
  glm::dvec3 spin_rad_per_s{};    ///< about the object's origin, in the workspace
  std::uint8_t material = 0;      ///< index in Scene::materials
  /// Contacts have interpolated normals, so that small facets feel like one curved surface. Interpolated normals
  /// are not conservative: a closed path can supply energy. Sharper edges than crease_rad remain edges.
  bool is_smooth = false;
  double crease_rad = 0.6;

  bool moves() const { return velocity_m_per_s != glm::dvec3{} || spin_rad_per_s != glm::dvec3{}; }
};

/// A scene does not change after its publication (publication.hpp). At most objects_max objects are felt.
struct Scene {
  std::vector<Object> objects;
  std::array<Material, materials_max> materials{};
};

/// The object's placement after a time. The object moves for at most 20 ms (motion_max_s) and then is stationary,
/// so that an object of a halted program does not run away.
Placement placement_after(const Object& object, double time_s);
inline constexpr double motion_max_s = 0.020;

}  // namespace inkwell::contact
