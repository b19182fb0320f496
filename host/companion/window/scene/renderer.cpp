#include "host/companion/window/scene/renderer.hpp"

#include <algorithm>
#include <cmath>

#include "host/companion/window/scene/shader_sources.hpp"

namespace inkwell::window {

namespace {

constexpr int samples_when_smooth = 4;
constexpr float floor_radius_m = 0.8f;
constexpr float floor_grid_m = 0.1f;
constexpr float wall_grid_m = 0.04f;

// A wall and its drawing attributes.
struct WallPicture {
  const WallView* wall;
  int u, v;            // axes along the wall
  glm::vec3 corner_m;  // in workspace axes
  glm::vec4 colour;    // without alpha
  float border_alpha, grid_alpha, face_alpha;
};

/// Returns the walls in drawing order.
std::vector<WallPicture> wall_pictures(const SceneModel& scene, const Camera& camera, const SceneLook& look) {
  const glm::mat3 to_view = workspace_to_view(scene.frame);
  std::vector<WallPicture> pictures;
  for (std::size_t i = 0; i < scene.walls.size(); ++i) {
    const WallView& wall = scene.walls[i];
    WallPicture picture{&wall, (wall.axis + 1) % 3, (wall.axis + 2) % 3, scene.box_minimum_m, {}, 0, 0, 0};
    if (wall.upper) picture.corner_m[wall.axis] = scene.box_maximum_m[wall.axis];
    // Walls between the eye and the inside of the box are transparent.
    const bool is_near = glm::dot(to_view * wall.inward, camera.eye_m() - to_view * picture.corner_m) < 0.0f;
    const bool is_marked = look.marked_wall == static_cast<int>(i);
    const bool touched = wall.pushes_back;
    picture.colour = to_vector(touched ? scene_colours::wall_touched : scene_colours::wall_idle);
    picture.border_alpha = look.flat_colours || touched || is_marked ? 1.0f : is_near ? 0.35f : 0.65f;
    picture.grid_alpha = touched ? (is_near ? 0.25f : 0.45f) : is_near ? 0.0f : 0.20f;
    picture.face_alpha = touched ? 0.17f : is_marked ? 0.14f : is_near ? 0.0f : 0.07f;
    pictures.push_back(picture);
  }
  // A wall in contact is drawn last, because its frame shares edges with adjacent walls.
  std::stable_partition(pictures.begin(), pictures.end(),
                        [](const WallPicture& each) { return !each.wall->pushes_back; });
  return pictures;
}

}  // namespace

Renderer::Renderer()
    : sky_(shaders::sky_vertex, shaders::sky_fragment),
      solid_(shaders::solid_vertex, shaders::solid_fragment),
      object_(shaders::object_vertex, shaders::solid_fragment),
      shadow_(shaders::shadow_vertex, shaders::shadow_fragment),
      wall_(shaders::wall_vertex, shaders::wall_fragment) {
  glGenVertexArrays(1, &no_vertices_);
  glGenFramebuffers(1, &target_);
  glGenRenderbuffers(2, target_buffers_.data());
}

Renderer::~Renderer() {
  glDeleteVertexArrays(1, &no_vertices_);
  glDeleteFramebuffers(1, &target_);
  glDeleteRenderbuffers(2, target_buffers_.data());
}

bool Renderer::size_target(int width, int height) {
  if (width == target_width_ && height == target_height_) return false;
  target_width_ = width;
  target_height_ = height;
  glBindRenderbuffer(GL_RENDERBUFFER, target_buffers_[0]);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_when_smooth, GL_RGBA8, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, target_buffers_[1]);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_when_smooth, GL_DEPTH24_STENCIL8, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, target_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target_buffers_[0]);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, target_buffers_[1]);
  return true;
}

void Renderer::prepare_solids(const Camera& camera, const SceneLook& look) const {
  solid_.use();
  solid_.set("to_clip", to_clip_);
  solid_.set("eye", camera.eye_m());
  solid_.set("lit", look.flat_colours ? 0.0f : 1.0f);
}

void Renderer::draw_objects(const Camera& camera, const SceneLook& look) const {
  object_.use();
  object_.set("eye", camera.eye_m());
  object_.set("lit", look.flat_colours ? 0.0f : 1.0f);
  object_.set("object_colour", scene_colours::object);
  objects_.draw(object_, to_clip_);
}

void Renderer::draw_sky(const Palette& palette) const {
  sky_.use();
  sky_.set("top", palette.sky_top);
  sky_.set("bottom", palette.sky_bottom);
  glBindVertexArray(no_vertices_);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void Renderer::draw_floor(const SceneModel& scene, const SceneLook& look) {
  // The floor lines fade with the distance from the middle.
  const glm::vec3 middle = workspace_to_view(scene.frame) * (0.5f * (scene.box_minimum_m + scene.box_maximum_m));
  const glm::vec4 colour = to_vector(look.palette.floor_line);
  const int count = static_cast<int>(floor_radius_m / floor_grid_m);
  const auto grid_point = [&](int i, int j) {
    return glm::vec3{middle.x + static_cast<float>(i) * floor_grid_m, scene.floor_height_m,
                     middle.z + static_cast<float>(j) * floor_grid_m};
  };
  const auto faded = [&](int i, int j) {
    const float distance = std::hypot(static_cast<float>(i), static_cast<float>(j)) / static_cast<float>(count);
    return glm::vec4{glm::vec3{colour}, 0.85f * std::clamp(1.15f * (1.0f - distance), 0.0f, 1.0f)};
  };
  constexpr int step = 2;  // cells per line segment
  for (int i = -count; i <= count; ++i) {
    for (int j = -count; j < count; j += step) {
      if (std::hypot(static_cast<float>(i), static_cast<float>(std::abs(j + step / 2))) > static_cast<float>(count))
        continue;
      lines_.add(grid_point(i, j), grid_point(i, j + step), faded(i, j), faded(i, j + step), 1.0f);
      lines_.add(grid_point(j, i), grid_point(j + step, i), faded(j, i), faded(j + step, i), 1.0f);
    }
  }
  lines_.draw(to_clip_, size_pixels_);
}

void Renderer::draw_shadows(const SceneModel& scene, const SceneLook& look) const {
  // The stencil buffer prevents overlapping bodies from darkening a shadow pixel twice.
  glm::mat4 flattened{1.0f};
  flattened[1][1] = 0.0f;
  flattened[3][1] = scene.floor_height_m + 0.0005f;
  shadow_.use();
  shadow_.set("to_clip", to_clip_ * flattened);
  shadow_.set("base_colour", look.palette.shadow);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 0, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  solids_.draw_shadow_casters();
  objects_.draw_shadows(shadow_, to_clip_ * flattened);
  glDisable(GL_STENCIL_TEST);
}

void Renderer::draw_walls(const SceneModel& scene, const Camera& camera, const SceneLook& look) {
  const glm::mat3 to_view = workspace_to_view(scene.frame);
  const glm::vec3 extent = scene.box_maximum_m - scene.box_minimum_m;
  wall_.use();
  wall_.set("to_clip", to_clip_);
  glBindVertexArray(no_vertices_);
  for (const WallPicture& picture : wall_pictures(scene, camera, look)) {
    // Clang 14 cannot capture structured bindings in lambdas.
    const auto [wall, u, v, corner_m, colour, border_alpha, grid_alpha, face_alpha] = picture;
    glm::vec3 edge_u{0.0f};
    glm::vec3 edge_v{0.0f};
    edge_u[u] = extent[u];
    edge_v[v] = extent[v];
    if (face_alpha > 0.0f) {
      wall_.set("corner", to_view * corner_m);
      wall_.set("edge_u", to_view * edge_u);
      wall_.set("edge_v", to_view * edge_v);
      wall_.set("base_colour", glm::vec4{glm::vec3{colour}, face_alpha});
      wall_.set("contact", glm::vec2{scene.proxy_m[u] - corner_m[u], scene.proxy_m[v] - corner_m[v]});
      wall_.set("glow", wall->pushes_back ? 0.6f : 0.0f);
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    const auto add = [&, colour = colour](glm::vec3 from, glm::vec3 to, float alpha, float width) {
      const glm::vec4 ink{glm::vec3{colour}, alpha};
      lines_.add(to_view * from, to_view * to, ink, ink, width);
    };
    if (grid_alpha > 0.0f) {
      const auto grid = [&, corner_m = corner_m, grid_alpha = grid_alpha](int across, glm::vec3 along) {
        const float first = std::ceil(corner_m[across] / wall_grid_m + 0.1f) * wall_grid_m;
        for (float at = first; at < corner_m[across] + extent[across] - 0.1f * wall_grid_m; at += wall_grid_m) {
          glm::vec3 from = corner_m;
          from[across] = at;
          add(from, from + along, grid_alpha, 1.0f);
        }
      };
      grid(u, edge_v);
      grid(v, edge_u);
    }
    const float width = wall->pushes_back ? 2.2f : 1.4f;
    add(corner_m, corner_m + edge_u, border_alpha, width);
    add(corner_m + edge_u, corner_m + edge_u + edge_v, border_alpha, width);
    add(corner_m + edge_u + edge_v, corner_m + edge_v, border_alpha, width);
    add(corner_m + edge_v, corner_m, border_alpha, width);
  }
  lines_.draw(to_clip_, size_pixels_);
}

void Renderer::draw(const SceneModel& scene, const std::vector<SceneObject>& objects,
                    const std::optional<HandView>& hand, const Camera& camera, const SceneLook& look,
                    const Viewport& viewport) {
  if (viewport.width < 2 || viewport.height < 2) return;
  size_pixels_ = {viewport.width, viewport.height};
  glDisable(GL_SCISSOR_TEST);
  if (look.smooth) {
    const bool is_fresh = size_target(viewport.width, viewport.height);
    if (look.is_as_before && target_is_drawn_ && !is_fresh) return show_target(viewport);
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glViewport(0, 0, viewport.width, viewport.height);
    glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  } else {
    target_is_drawn_ = false;
    glViewport(viewport.x, viewport.y, viewport.width, viewport.height);
  }
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_DEPTH_TEST);
  draw_sky(look.palette);

  to_clip_ =
      camera.projection(static_cast<float>(viewport.width) / static_cast<float>(viewport.height)) * camera.view();
  solids_.fill(solids_of(scene, hand, look.palette), look.flat_colours);
  objects_.fill(objects, workspace_to_view(scene.frame));
  glEnable(GL_DEPTH_TEST);
  prepare_solids(camera, look);
  solids_.draw_opaque();
  draw_objects(camera, look);
  // Transparent parts use the depth test but do not write depth.
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  draw_floor(scene, look);
  draw_shadows(scene, look);
  draw_walls(scene, camera, look);
  prepare_solids(camera, look);
  solids_.draw_see_through();
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
  glUseProgram(0);

  if (!look.smooth) return;
  target_is_drawn_ = true;
  show_target(viewport);
}

void Renderer::show_target(const Viewport& viewport) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, viewport.width, viewport.height, viewport.x, viewport.y, viewport.x + viewport.width,
                    viewport.y + viewport.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace inkwell::window
