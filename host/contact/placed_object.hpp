// Objects at their placement in one step.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "host/contact/scene.hpp"

namespace inkwell::contact {

/// Has no initial values, so that an array of objects costs no time.
struct PlacedObject {
  const Object* object;
  const geometry::Surface* surface;  ///< nullptr: one of the solids
  glm::dmat3 rotation;               ///< into the workspace
  glm::dvec3 origin_m;               ///< of the frame of the surface or solid, in the workspace
  bool is_moving;
  bool is_felt;

  glm::dvec3 to_workspace(const glm::dvec3& point_m) const { return origin_m + rotation * point_m; }
  glm::dvec3 to_object(const glm::dvec3& point_m) const { return (point_m - origin_m) * rotation; }
  glm::dvec3 turned_to_object(const glm::dvec3& vector) const { return vector * rotation; }
};

/// Face of a placed object.
struct FaceOfObject {
  std::size_t object;
  std::uint32_t face;  ///< in the order of the tree; 0 for solids
};

/// An object with a mesh but no surface is not felt.
PlacedObject place(const Object& object, const Placement& placement);

}  // namespace inkwell::contact
