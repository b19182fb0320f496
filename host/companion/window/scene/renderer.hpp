// Draws the scene with OpenGL 3.3 core.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <epoxy/gl.h>

#include "host/companion/window/frame/palette.hpp"
#include "host/companion/window/scene/camera.hpp"
#include "host/companion/window/scene/scene_look.hpp"
#include "host/companion/window/scene/scene_model.hpp"
#include "host/companion/window/scene/scene_objects.hpp"
#include "host/companion/window/scene/scene_solids.hpp"

#include "host/companion/window/scene/line_batch.hpp"
#include "host/companion/window/scene/object_batch.hpp"
#include "host/companion/window/scene/shader.hpp"
#include "host/companion/window/scene/solid_batch.hpp"

namespace inkwell::window {

class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws into a part of the window's framebuffer. The depth and stencil buffers of this part must be clear.
  void draw(const SceneModel& scene, const std::vector<SceneObject>& objects, const std::optional<HandView>& hand,
            const Camera& camera, const SceneLook& look, const Viewport& viewport);

 private:
  void show_target(const Viewport& viewport) const;
  /// Sets the size of the target. Returns true if the size has changed.
  bool size_target(int width, int height);
  void prepare_solids(const Camera& camera, const SceneLook& look) const;
  void draw_objects(const Camera& camera, const SceneLook& look) const;
  void draw_sky(const Palette& palette) const;
  void draw_floor(const SceneModel& scene, const SceneLook& look);
  void draw_shadows(const SceneModel& scene, const SceneLook& look) const;
  void draw_walls(const SceneModel& scene, const Camera& camera, const SceneLook& look);

  GLuint no_vertices_ = 0;
  GLuint target_ = 0;
  std::array<GLuint, 2> target_buffers_{};  // color; depth with stencil
  int target_width_ = 0;
  int target_height_ = 0;
  bool target_is_drawn_ = false;
  glm::vec2 size_pixels_{1.0f};
  glm::mat4 to_clip_{1.0f};
  ShaderProgram sky_;
  ShaderProgram solid_;
  ShaderProgram object_;
  ShaderProgram shadow_;
  ShaderProgram wall_;
  LineBatch lines_;
  SolidBatch solids_;
  ObjectBatch objects_;
};

}  // namespace inkwell::window
