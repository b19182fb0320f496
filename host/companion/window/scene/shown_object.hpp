// Objects that the scene shows next to arm and walls.
#pragma once

#include <memory>
#include <string>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "host/geometry/mesh.hpp"

namespace inkwell::window {

/// A mesh and its placement in workspace axes. The mesh must not change while any ShownObject refers to it, because
/// the window prepares each mesh only once.
struct ShownObject {
  std::shared_ptr<const geometry::Mesh> mesh;  ///< null: nothing is shown
  glm::vec3 position_m{0.0f};                  ///< of the origin of the mesh
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< unit quaternion, from mesh axes to workspace axes

  bool operator==(const ShownObject&) const = default;
};

/// State of the loading of objects.
struct ObjectLoading {
  std::string progress{};  ///< work that goes on; empty: none
  std::string problem{};   ///< sentences about an object that cannot be used; empty: none

  bool operator==(const ObjectLoading&) const = default;
};

}  // namespace inkwell::window
