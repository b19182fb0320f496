#include "host/companion/window/scene/object_batch.hpp"

#include <algorithm>

namespace inkwell::window {

ObjectBatch::~ObjectBatch() {
  for (const auto& [number, mesh] : meshes_) remove(mesh);
}

void ObjectBatch::remove(const Uploaded& mesh) {
  glDeleteVertexArrays(1, &mesh.vertex_array);
  glDeleteBuffers(2, mesh.buffers.data());
}

ObjectBatch::Uploaded ObjectBatch::upload(const DrawnMesh& mesh) {
  Uploaded uploaded;
  glGenVertexArrays(1, &uploaded.vertex_array);
  glGenBuffers(2, uploaded.buffers.data());
  glBindVertexArray(uploaded.vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, uploaded.buffers[0]);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, uploaded.buffers[1]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(DrawnVertex)),
               mesh.vertices.data(), GL_STATIC_DRAW);
  const auto bytes = [](const std::vector<std::uint32_t>& indices) {
    return static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t));
  };
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(mesh.indices) + bytes(mesh.shadow_indices), nullptr, GL_STATIC_DRAW);
  glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, bytes(mesh.indices), mesh.indices.data());
  glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, bytes(mesh.indices), bytes(mesh.shadow_indices), mesh.shadow_indices.data());
  const auto attribute = [](GLuint location, std::size_t offset) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, sizeof(DrawnVertex), reinterpret_cast<void*>(offset));
  };
  attribute(0, offsetof(DrawnVertex, position_m));
  attribute(1, offsetof(DrawnVertex, normal));
  glBindVertexArray(0);
  uploaded.index_count = static_cast<GLsizei>(mesh.indices.size());
  uploaded.shadow_index_count = static_cast<GLsizei>(mesh.shadow_indices.size());
  uploaded.is_solid = mesh.is_solid;
  uploaded.can_cull = mesh.is_solid && !mesh.is_decimated;
  return uploaded;
}

void ObjectBatch::fill(const std::vector<SceneObject>& objects, const glm::mat3& workspace_to_view) {
  std::erase_if(meshes_, [&objects](const auto& entry) {
    const bool is_shown = std::ranges::any_of(
        objects, [&entry](const SceneObject& object) { return object.preparation->number == entry.first; });
    if (!is_shown) remove(entry.second);
    return !is_shown;
  });
  placed_.clear();
  for (const SceneObject& object : objects) {
    if (!object.is_ready || object.mesh().indices.empty()) continue;
    const auto [entry, is_new] = meshes_.try_emplace(object.preparation->number);
    if (is_new) entry->second = upload(object.mesh());
    placed_.push_back({&entry->second, glm::mat4{workspace_to_view} * object.to_workspace()});
  }
}

void ObjectBatch::draw(const ShaderProgram& program, const glm::mat4& to_clip) const {
  program.set("to_clip", to_clip);
  for (const Placed& placed : placed_) {
    program.set("to_view", placed.to_view);
    program.set("two_sided", placed.mesh->is_solid ? 0.0f : 1.0f);
    placed.mesh->can_cull ? glEnable(GL_CULL_FACE) : glDisable(GL_CULL_FACE);
    glBindVertexArray(placed.mesh->vertex_array);
    glDrawElements(GL_TRIANGLES, placed.mesh->index_count, GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_CULL_FACE);
}

void ObjectBatch::draw_shadows(const ShaderProgram& program, const glm::mat4& to_clip) const {
  for (const Placed& placed : placed_) {
    program.set("to_clip", to_clip * placed.to_view);
    glBindVertexArray(placed.mesh->vertex_array);
    glDrawElements(GL_TRIANGLES, placed.mesh->shadow_index_count, GL_UNSIGNED_INT,
                   reinterpret_cast<void*>(static_cast<std::size_t>(placed.mesh->index_count) * sizeof(std::uint32_t)));
  }
}

}  // namespace inkwell::window
