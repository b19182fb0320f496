#include "renderer.hpp"

#include <algorithm>
#include <cmath>

#include "shader_sources.hpp"

namespace inkwell::window {

namespace {

constexpr int samples_per_pixel = 4;
constexpr float floor_size_m = 1.6f;

}  // namespace

Renderer::Renderer()
    : sky_(shaders::sky_vertex, shaders::sky_fragment),
      solid_(shaders::solid_vertex, shaders::solid_fragment),
      shadow_(shaders::solid_vertex, shaders::shadow_fragment),
      wall_(shaders::panel_vertex, shaders::wall_fragment),
      floor_(shaders::panel_vertex, shaders::floor_fragment) {
  bodies_ = {upload(sphere(14, 24)), upload(tapered_cylinder(1.0f, 24)), upload(tapered_cylinder(0.72f, 24)),
             upload(tapered_cylinder(0.0f, 20)), upload(coil(9, 0.28f, 14, 6))};
  glGenVertexArrays(1, &no_vertices_);
  glGenFramebuffers(1, &target_);
  glGenRenderbuffers(2, target_buffers_.data());
}

Renderer::~Renderer() {
  for (const Body& body : bodies_) {
    glDeleteVertexArrays(1, &body.vertex_array);
    glDeleteBuffers(1, &body.vertices);
    glDeleteBuffers(1, &body.indices);
  }
  glDeleteVertexArrays(1, &no_vertices_);
  glDeleteFramebuffers(1, &target_);
  glDeleteRenderbuffers(2, target_buffers_.data());
}

Renderer::Body Renderer::upload(const Mesh& mesh) {
  Body body{};
  glGenVertexArrays(1, &body.vertex_array);
  glGenBuffers(1, &body.vertices);
  glGenBuffers(1, &body.indices);
  glBindVertexArray(body.vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, body.vertices);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vertex)), mesh.vertices.data(),
               GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, body.indices);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint16_t)),
               mesh.indices.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<void*>(offsetof(Vertex, normal)));
  glBindVertexArray(0);
  body.count = static_cast<GLsizei>(mesh.indices.size());
  return body;
}

void Renderer::size_target(int width, int height) {
  if (width == target_width_ && height == target_height_) return;
  target_width_ = width;
  target_height_ = height;
  glBindRenderbuffer(GL_RENDERBUFFER, target_buffers_[0]);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_per_pixel, GL_RGBA8, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, target_buffers_[1]);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_per_pixel, GL_DEPTH24_STENCIL8, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, target_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target_buffers_[0]);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, target_buffers_[1]);
}

void Renderer::draw_solids(const std::vector<Solid>& solids, bool opaque, const Camera& camera,
                           const SceneLook& look) const {
  solid_.use();
  solid_.set("to_clip", to_clip_);
  solid_.set("eye", camera.eye_m());
  solid_.set("lit", look.flat_colours ? 0.0f : 1.0f);
  for (const Solid& solid : solids) {
    const bool drawn_opaque = look.flat_colours || solid.colour.alpha == 255;
    if (drawn_opaque != opaque) continue;
    solid_.set("placement", solid.placement);
    solid_.set("base_colour", look.flat_colours ? solid.colour.with_alpha(255) : solid.colour);
    solid_.set("shininess", solid.shininess);
    const Body& body = bodies_[static_cast<std::size_t>(solid.shape)];
    glBindVertexArray(body.vertex_array);
    glDrawElements(GL_TRIANGLES, body.count, GL_UNSIGNED_SHORT, nullptr);
  }
}

void Renderer::draw_floor(const std::vector<Solid>& solids, const SceneModel& scene, const SceneLook& look) const {
  const glm::vec3 middle = workspace_to_view(scene.frame) * (0.5f * (scene.box_minimum_m + scene.box_maximum_m));
  const glm::vec3 corner{middle.x - 0.5f * floor_size_m, scene.floor_height_m, middle.z + 0.5f * floor_size_m};
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  floor_.use();
  floor_.set("to_clip", to_clip_);
  floor_.set("corner", corner);
  floor_.set("edge_u", glm::vec3{floor_size_m, 0.0f, 0.0f});
  floor_.set("edge_v", glm::vec3{0.0f, 0.0f, -floor_size_m});
  floor_.set("size", glm::vec2{floor_size_m});
  floor_.set("line_colour", look.palette.floor_line);
  glBindVertexArray(no_vertices_);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);

  // Shadows straight down: what lies under the sphere on the floor tells its depth in the picture. The stencil
  // lets each pixel be darkened once only, however many bodies lie over it.
  glm::mat4 flattened{1.0f};
  flattened[1][1] = 0.0f;
  flattened[3][1] = scene.floor_height_m + 0.0005f;
  shadow_.use();
  shadow_.set("to_clip", to_clip_ * flattened);
  shadow_.set("base_colour", look.palette.shadow);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 0, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  for (const Solid& solid : solids) {
    if (!solid.casts_shadow) continue;
    shadow_.set("placement", solid.placement);
    const Body& body = bodies_[static_cast<std::size_t>(solid.shape)];
    glBindVertexArray(body.vertex_array);
    glDrawElements(GL_TRIANGLES, body.count, GL_UNSIGNED_SHORT, nullptr);
  }
  glDisable(GL_STENCIL_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Renderer::draw_walls(const SceneModel& scene, const Camera& camera, const SceneLook& look) const {
  const glm::mat3 to_view = workspace_to_view(scene.frame);
  const glm::vec3 extent = scene.box_maximum_m - scene.box_minimum_m;
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  wall_.use();
  wall_.set("to_clip", to_clip_);
  glBindVertexArray(no_vertices_);
  // Far walls first: those whose free side faces the eye. The near ones stay see-through.
  for (bool near_side : {false, true}) {
    for (std::size_t i = 0; i < scene.walls.size(); ++i) {
      const WallView& wall = scene.walls[i];
      const int u = (wall.axis + 1) % 3;
      const int v = (wall.axis + 2) % 3;
      glm::vec3 corner = scene.box_minimum_m;
      if (wall.upper) corner[wall.axis] = scene.box_maximum_m[wall.axis];
      const bool faces_away = glm::dot(to_view * wall.inward, camera.eye_m() - to_view * corner) < 0.0f;
      if (faces_away != near_side) continue;
      glm::vec3 edge_u{0.0f};
      glm::vec3 edge_v{0.0f};
      edge_u[u] = extent[u];
      edge_v[v] = extent[v];
      const bool marked = look.marked_wall == static_cast<int>(i);
      const Colour colour = wall.pushes_back ? scene_colours::wall_touched : scene_colours::wall_idle;
      const float frame = look.flat_colours || wall.pushes_back || marked ? 1.0f : near_side ? 0.30f : 0.62f;
      wall_.set("corner", to_view * corner);
      wall_.set("edge_u", to_view * edge_u);
      wall_.set("edge_v", to_view * edge_v);
      wall_.set("size", glm::vec2{extent[u], extent[v]});
      wall_.set("frame_colour", glm::vec4{glm::vec3{to_vector(colour)}, frame});
      wall_.set("fill", wall.pushes_back ? 0.16f : marked ? 0.14f : near_side ? 0.0f : 0.07f);
      wall_.set("grid", near_side ? (wall.pushes_back ? 0.20f : 0.0f) : (wall.pushes_back ? 0.34f : 0.17f));
      wall_.set("contact", glm::vec2{scene.proxy_m[u] - corner[u], scene.proxy_m[v] - corner[v]});
      wall_.set("glow", wall.pushes_back ? 1.0f : 0.0f);
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Renderer::draw(const SceneModel& scene, const std::optional<HandView>& hand, const Camera& camera,
                    const SceneLook& look, const Viewport& viewport) {
  if (viewport.width < 2 || viewport.height < 2) return;
  size_target(viewport.width, viewport.height);
  glBindFramebuffer(GL_FRAMEBUFFER, target_);
  glViewport(0, 0, viewport.width, viewport.height);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glEnable(GL_MULTISAMPLE);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);

  glDisable(GL_DEPTH_TEST);
  sky_.use();
  sky_.set("top", look.palette.sky_top);
  sky_.set("bottom", look.palette.sky_bottom);
  glBindVertexArray(no_vertices_);
  glDrawArrays(GL_TRIANGLES, 0, 3);

  to_clip_ = camera.projection(static_cast<float>(viewport.width) / static_cast<float>(viewport.height)) * camera.view();
  const std::vector<Solid> solids = solids_of(scene, hand, look.palette);
  glEnable(GL_DEPTH_TEST);
  draw_floor(solids, scene, look);
  draw_solids(solids, true, camera, look);
  draw_walls(scene, camera, look);
  glEnable(GL_BLEND);
  draw_solids(solids, false, camera, look);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
  glUseProgram(0);

  glBindFramebuffer(GL_READ_FRAMEBUFFER, target_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, viewport.width, viewport.height, viewport.x, viewport.y, viewport.x + viewport.width,
                    viewport.y + viewport.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace inkwell::window
