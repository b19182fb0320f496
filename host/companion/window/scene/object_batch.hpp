// Draws the objects of the scene. Each mesh is uploaded once, and the GPU applies the placements.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include "host/companion/window/scene/scene_objects.hpp"
#include "host/companion/window/scene/shader.hpp"

namespace inkwell::window {

class ObjectBatch {
 public:
  ObjectBatch() = default;
  ~ObjectBatch();
  ObjectBatch(const ObjectBatch&) = delete;
  ObjectBatch& operator=(const ObjectBatch&) = delete;

  /// Sets the objects of this frame. Uploads new meshes and removes the meshes that are no longer shown.
  void fill(const std::vector<SceneObject>& objects, const glm::mat3& workspace_to_view);

  /// The program has the uniforms of shaders::object_vertex, and is in use.
  void draw(const ShaderProgram& program, const glm::mat4& to_clip) const;
  /// The program has the uniform `to_clip`, and is in use.
  void draw_shadows(const ShaderProgram& program, const glm::mat4& to_clip) const;

 private:
  struct Uploaded {
    GLuint vertex_array = 0;
    std::array<GLuint, 2> buffers{};  // vertices, indices
    GLsizei index_count = 0;
    GLsizei shadow_index_count = 0;  // after the other indices
    bool is_solid = false;
    bool can_cull = false;  // the rear sides of the triangles are not drawn
  };
  struct Placed {
    const Uploaded* mesh;
    glm::mat4 to_view;
  };

  static Uploaded upload(const DrawnMesh& mesh);
  static void remove(const Uploaded& mesh);

  std::map<std::uint64_t, Uploaded> meshes_;  // by MeshPreparation::number
  std::vector<Placed> placed_;
};

}  // namespace inkwell::window
