#include "host/companion/window/scene/solid_batch.hpp"

#include <cstddef>

namespace inkwell::window {

SolidBatch::SolidBatch()
    : meshes_{sphere(10, 18), tapered_cylinder(1.0f, 22), tapered_cylinder(0.72f, 22), tapered_cylinder(0.0f, 16),
              coil(8, 0.28f, 12, 5)} {
  glGenVertexArrays(1, &vertex_array_);
  glGenBuffers(2, buffers_.data());
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  const auto attribute = [](GLuint location, GLint size, GLenum type, GLboolean normalised, std::size_t offset) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, size, type, normalised, sizeof(Corner), reinterpret_cast<void*>(offset));
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(Corner, position));
  attribute(1, 3, GL_FLOAT, GL_FALSE, offsetof(Corner, normal));
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Corner, colour));
  attribute(3, 1, GL_FLOAT, GL_FALSE, offsetof(Corner, shininess));
  glBindVertexArray(0);
}

SolidBatch::~SolidBatch() {
  glDeleteVertexArrays(1, &vertex_array_);
  glDeleteBuffers(2, buffers_.data());
}

void SolidBatch::append(const Solid& solid, bool opaque) {
  const Mesh& mesh = meshes_[static_cast<std::size_t>(solid.shape)];
  const auto first = static_cast<std::uint16_t>(corners_.size());
  const glm::mat3 turn{solid.transform};
  // Transforms normals with the inverse transpose of the matrix. Bodies are scaled only along their axes, so a division
  // by the squared scale is sufficient.
  const glm::vec3 stretch_squared{glm::dot(turn[0], turn[0]), glm::dot(turn[1], turn[1]), glm::dot(turn[2], turn[2])};
  for (const Vertex& vertex : mesh.vertices)
    corners_.push_back({glm::vec3{solid.transform * glm::vec4{vertex.position, 1.0f}},
                        turn * (vertex.normal / stretch_squared), opaque ? solid.colour.with_alpha(255) : solid.colour,
                        solid.shininess});
  for (std::uint16_t index : mesh.indices) indices_.push_back(static_cast<std::uint16_t>(first + index));
}

void SolidBatch::fill(const std::vector<Solid>& solids, bool all_opaque) {
  corners_.clear();
  indices_.clear();
  const auto is_opaque = [all_opaque](const Solid& solid) { return all_opaque || solid.colour.alpha == 255; };
  for (const Solid& solid : solids)
    if (solid.casts_shadow && is_opaque(solid)) append(solid, true);
  shadow_casters_end_ = static_cast<GLsizei>(indices_.size());
  for (const Solid& solid : solids)
    if (!solid.casts_shadow && is_opaque(solid)) append(solid, true);
  opaque_end_ = static_cast<GLsizei>(indices_.size());
  for (const Solid& solid : solids)
    if (!is_opaque(solid)) append(solid, false);

  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners_.size() * sizeof(Corner)), corners_.data(),
               GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices_.size() * sizeof(std::uint16_t)),
               indices_.data(), GL_STREAM_DRAW);
}

void SolidBatch::draw(GLsizei first, GLsizei end) const {
  if (first == end) return;
  glBindVertexArray(vertex_array_);
  glDrawElements(GL_TRIANGLES, end - first, GL_UNSIGNED_SHORT,
                 reinterpret_cast<void*>(static_cast<std::size_t>(first) * sizeof(std::uint16_t)));
}

}  // namespace inkwell::window
