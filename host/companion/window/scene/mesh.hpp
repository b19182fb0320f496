// Triangle meshes of the solids.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace inkwell::window {

struct Vertex {
  glm::vec3 position;
  glm::vec3 normal;
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint16_t> indices;
};

/// Unit sphere around the origin.
Mesh sphere(int rings, int segments);

/// Cone or cylinder with flat ends from z = 0 to z = 1. The radius is 1 at z = 0 and `end_radius` at z = 1.
Mesh tapered_cylinder(float end_radius, int segments);

/// Helical spring with coil radius 1 from z = 0 to z = 1.
Mesh coil(int turns, float wire_radius, int segments_per_turn, int segments_around);

/// Returns the transformation that maps the z axis from 0 to 1 onto the line between two points.
glm::mat4 between(glm::vec3 from, glm::vec3 to, float radius);

}  // namespace inkwell::window
