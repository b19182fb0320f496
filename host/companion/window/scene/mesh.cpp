#include "host/companion/window/scene/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace inkwell::window {

namespace {

constexpr float pi = 3.14159265f;

void add_quad(Mesh& mesh, int a, int b, int c, int d) {
  for (int index : {a, b, c, a, c, d}) mesh.indices.push_back(static_cast<std::uint16_t>(index));
}

void add_disc(Mesh& mesh, float z, float radius, float normal_z, int segments) {
  const int centre = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back({{0.0f, 0.0f, z}, {0.0f, 0.0f, normal_z}});
  for (int i = 0; i <= segments; ++i) {
    const float angle = 2.0f * pi * static_cast<float>(i) / static_cast<float>(segments);
    mesh.vertices.push_back({{radius * std::cos(angle), radius * std::sin(angle), z}, {0.0f, 0.0f, normal_z}});
  }
  for (int i = 0; i < segments; ++i) {
    const int first = centre + 1 + i + (normal_z > 0.0f ? 0 : 1);
    const int second = centre + 1 + i + (normal_z > 0.0f ? 1 : 0);
    for (int index : {centre, first, second}) mesh.indices.push_back(static_cast<std::uint16_t>(index));
  }
}

}  // namespace

Mesh sphere(int rings, int segments) {
  Mesh mesh;
  for (int ring = 0; ring <= rings; ++ring) {
    const float latitude = pi * static_cast<float>(ring) / static_cast<float>(rings);
    for (int i = 0; i <= segments; ++i) {
      const float longitude = 2.0f * pi * static_cast<float>(i) / static_cast<float>(segments);
      const glm::vec3 point{std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude),
                            std::cos(latitude)};
      mesh.vertices.push_back({point, point});
    }
  }
  const int row = segments + 1;
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < segments; ++i)
      add_quad(mesh, ring * row + i, (ring + 1) * row + i, (ring + 1) * row + i + 1, ring * row + i + 1);
  return mesh;
}

Mesh tapered_cylinder(float end_radius, int segments) {
  Mesh mesh;
  for (int i = 0; i <= segments; ++i) {
    const float angle = 2.0f * pi * static_cast<float>(i) / static_cast<float>(segments);
    const glm::vec3 outward{std::cos(angle), std::sin(angle), 0.0f};
    mesh.vertices.push_back({outward, outward});
    mesh.vertices.push_back({end_radius * outward + glm::vec3{0.0f, 0.0f, 1.0f}, outward});
  }
  for (int i = 0; i < segments; ++i) add_quad(mesh, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
  add_disc(mesh, 0.0f, 1.0f, -1.0f, segments);
  if (end_radius > 0.0f) add_disc(mesh, 1.0f, end_radius, 1.0f, segments);
  return mesh;
}

Mesh coil(int turns, float wire_radius, int segments_per_turn, int segments_around) {
  Mesh mesh;
  const int steps = turns * segments_per_turn;
  for (int step = 0; step <= steps; ++step) {
    const float part = static_cast<float>(step) / static_cast<float>(steps);
    const float angle = 2.0f * pi * static_cast<float>(turns) * part;
    // The coil radius decreases to zero at each end of the spring.
    const float radius = std::min({1.0f, part * 8.0f, (1.0f - part) * 8.0f});
    const glm::vec3 outward{std::cos(angle), std::sin(angle), 0.0f};
    for (int i = 0; i <= segments_around; ++i) {
      const float around = 2.0f * pi * static_cast<float>(i) / static_cast<float>(segments_around);
      // The cross-section is flattened along z, because the mesh is later stretched to the length of the spring.
      const glm::vec3 normal = std::cos(around) * outward + std::sin(around) * glm::vec3{0.0f, 0.0f, 1.0f};
      const glm::vec3 offset =
          wire_radius * (std::cos(around) * outward + 0.06f * std::sin(around) * glm::vec3{0, 0, 1});
      mesh.vertices.push_back({radius * outward + glm::vec3{0.0f, 0.0f, part} + offset, normal});
    }
  }
  const int row = segments_around + 1;
  for (int step = 0; step < steps; ++step)
    for (int i = 0; i < segments_around; ++i)
      add_quad(mesh, step * row + i, (step + 1) * row + i, (step + 1) * row + i + 1, step * row + i + 1);
  return mesh;
}

glm::mat4 between(glm::vec3 from, glm::vec3 to, float radius) {
  const glm::vec3 along = to - from;
  const float length = glm::length(along);
  const glm::vec3 axis = length > 1e-6f ? along / length : glm::vec3{0.0f, 0.0f, 1.0f};
  const glm::vec3 helper = std::abs(axis.y) < 0.9f ? glm::vec3{0.0f, 1.0f, 0.0f} : glm::vec3{1.0f, 0.0f, 0.0f};
  const glm::vec3 side = glm::normalize(glm::cross(helper, axis));
  return {glm::vec4{radius * side, 0.0f}, glm::vec4{radius * glm::cross(axis, side), 0.0f}, glm::vec4{along, 0.0f},
          glm::vec4{from, 1.0f}};
}

}  // namespace inkwell::window
