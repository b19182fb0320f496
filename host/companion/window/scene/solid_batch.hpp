// The solid bodies of a frame in one vertex buffer. The CPU transforms the vertices, because one draw call per body
// would be slower.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <epoxy/gl.h>

#include "host/companion/window/scene/mesh.hpp"
#include "host/companion/window/scene/scene_solids.hpp"

namespace inkwell::window {

class SolidBatch {
 public:
  SolidBatch();
  ~SolidBatch();
  SolidBatch(const SolidBatch&) = delete;
  SolidBatch& operator=(const SolidBatch&) = delete;

  /// Sets the bodies of this frame. If `all_opaque` is true, transparent bodies are drawn as opaque bodies.
  void fill(const std::vector<Solid>& solids, bool all_opaque);

  void draw_shadow_casters() const { draw(0, shadow_casters_end_); }
  void draw_opaque() const { draw(0, opaque_end_); }
  void draw_see_through() const { draw(opaque_end_, static_cast<GLsizei>(indices_.size())); }

 private:
  struct Corner {
    glm::vec3 position;
    glm::vec3 normal;
    Colour colour;
    float shininess;
  };

  void append(const Solid& solid, bool opaque);
  void draw(GLsizei first, GLsizei end) const;

  std::array<Mesh, 5> meshes_;  // in the order of Shape
  std::vector<Corner> corners_;
  std::vector<std::uint16_t> indices_;
  GLsizei shadow_casters_end_ = 0;
  GLsizei opaque_end_ = 0;
  GLuint vertex_array_ = 0;
  std::array<GLuint, 2> buffers_{};  // vertices, indices
};

}  // namespace inkwell::window
