// Triangles of the scene's solids, made on the processor once.
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

/// Radius 1 around the origin.
Mesh sphere(int rings, int segments);

/// A body of revolution about z from z = 0 to z = 1, radius 1 at the start and `end_radius` at the end, with flat
/// ends. Scaled in x and y it is a cylinder (1), a tapered link, or a cone (0).
Mesh tapered_cylinder(float end_radius, int segments);

/// A helix about z from z = 0 to z = 1, its coils of radius 1, drawn as a tube. For the hand's spring.
Mesh coil(int turns, float wire_radius, int segments_per_turn, int segments_around);

/// Moves, turns and stretches a mesh that lies along z from 0 to 1 so that it goes from one point to the other.
glm::mat4 between(glm::vec3 from, glm::vec3 to, float radius);

}  // namespace inkwell::window
