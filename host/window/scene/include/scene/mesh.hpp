// Triangle meshes of the solids, computed once on the CPU.
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

/// Body of revolution about z from z = 0 to z = 1 with flat ends. The radius is 1 at z = 0 and `end_radius` at z = 1.
/// `end_radius` 1 gives a cylinder, and 0 a cone.
Mesh tapered_cylinder(float end_radius, int segments);

/// Helical spring about z from z = 0 to z = 1 with coil radius 1, drawn as a tube. The hand's spring uses this mesh.
Mesh coil(int turns, float wire_radius, int segments_per_turn, int segments_around);

/// Returns the transformation of a mesh along z from 0 to 1 to the line between two points.
glm::mat4 between(glm::vec3 from, glm::vec3 to, float radius);

}  // namespace inkwell::window
