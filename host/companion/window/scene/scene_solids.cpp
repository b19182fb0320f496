#include "host/companion/window/scene/scene_solids.hpp"

#include <algorithm>

#include "host/companion/window/scene/mesh.hpp"

namespace inkwell::window {

namespace {

constexpr float smallest_drawn_sphere_m = 0.002f;
constexpr float least_drawn_force_N = 0.02f;
constexpr float least_drawn_pull_m = 0.0015f;

class Builder {
 public:
  explicit Builder(control::Frame frame) : to_view_(workspace_to_view(frame)) {}

  void ball(glm::vec3 centre, float radius, Colour colour, float shininess = 0.25f) {
    glm::mat4 transform{radius};
    transform[3] = glm::vec4{to_view_ * centre, 1.0f};
    add({Shape::sphere, transform, colour, shininess});
  }
  void rod(Shape shape, glm::vec3 from, glm::vec3 to, float radius, Colour colour, float shininess = 0.25f) {
    add({shape, between(to_view_ * from, to_view_ * to, radius), colour, shininess});
  }
  void without_shadow() { solids_.back().casts_shadow = false; }
  std::vector<Solid> take() { return std::move(solids_); }

 private:
  void add(Solid solid) { solids_.push_back(solid); }
  glm::mat3 to_view_;
  std::vector<Solid> solids_;
};

// The arm description defines lengths and angles. The thicknesses of the links are chosen for appearance.
void add_arm(Builder& builder, const SceneModel& scene, glm::vec3 up, const Palette& palette) {
  const glm::vec3 foot = scene.shoulder_m + up * (scene.floor_height_m - glm::dot(scene.shoulder_m, up));
  const glm::vec3 link_3 = glm::normalize(scene.probe_m - scene.elbow_m);
  const glm::vec3 side = scene.arm_side;

  builder.rod(Shape::cylinder, foot, foot + 0.012f * up, 0.062f, palette.metal_dark, 0.1f);
  builder.rod(Shape::tapered, foot + 0.012f * up, scene.shoulder_m - 0.028f * up, 0.052f, palette.metal_dark, 0.2f);
  builder.rod(Shape::cylinder, scene.shoulder_m - 0.028f * up, scene.shoulder_m - 0.022f * up, 0.037f, palette.metal,
              0.5f);
  builder.rod(Shape::cylinder, scene.shoulder_m - 0.030f * side, scene.shoulder_m + 0.030f * side, 0.022f,
              palette.metal_dark, 0.3f);
  builder.rod(Shape::cylinder, scene.shoulder_m + 0.030f * side, scene.shoulder_m + 0.033f * side, 0.015f,
              palette.metal, 0.6f);
  builder.rod(Shape::cylinder, scene.shoulder_m - 0.033f * side, scene.shoulder_m - 0.030f * side, 0.015f,
              palette.metal, 0.6f);

  builder.rod(Shape::tapered, scene.shoulder_m, scene.elbow_m, 0.0125f, palette.metal, 0.4f);
  builder.rod(Shape::cylinder, scene.elbow_m - 0.013f * side, scene.elbow_m + 0.013f * side, 0.0125f,
              palette.metal_dark, 0.3f);
  builder.rod(Shape::tapered, scene.elbow_m, scene.probe_m - 0.006f * link_3, 0.0085f, palette.metal, 0.4f);

  if (scene.parallelogram) {
    // Motor 3 rotates a crank at the shoulder. A rod parallel to link 2 transmits the crank angle to link 3.
    const float crank_m = 0.030f;
    const glm::vec3 aside = 0.018f * side;
    const glm::vec3 crank = scene.shoulder_m - crank_m * link_3 + aside;
    const glm::vec3 tail = scene.elbow_m - crank_m * link_3;
    builder.rod(Shape::cylinder, scene.shoulder_m + aside, crank, 0.005f, palette.metal_dark, 0.3f);
    builder.rod(Shape::cylinder, scene.elbow_m, tail, 0.007f, palette.metal, 0.4f);
    builder.rod(Shape::cylinder, crank, tail + aside, 0.0035f, palette.metal, 0.5f);
    builder.rod(Shape::cylinder, tail, tail + aside, 0.0045f, palette.metal_dark, 0.3f);
  }

  const glm::vec3 stylus = scene.stylus_direction;
  const glm::vec3 grip = scene.probe_m + 0.018f * stylus;
  builder.rod(Shape::cylinder, scene.probe_m, grip, 0.0028f, palette.metal, 0.6f);
  builder.rod(Shape::tapered, scene.probe_m + 0.120f * stylus, grip, 0.0078f, palette.metal_dark, 0.35f);
  for (float along : {0.034f, 0.048f})
    builder.rod(Shape::cylinder, scene.probe_m + along * stylus + 0.004f * scene.stylus_side,
                scene.probe_m + along * stylus + 0.0085f * scene.stylus_side, 0.0032f, palette.metal, 0.5f);
}

}  // namespace

glm::vec3 force_arrow_tip_m(const SceneModel& scene) { return scene.probe_m + force_arrow_m_per_N * scene.force_N; }

std::vector<Solid> solids_of(const SceneModel& scene, const std::optional<HandView>& hand, const Palette& palette) {
  Builder builder(scene.frame);
  const glm::vec3 up = scene.frame == control::Frame::paper ? glm::vec3{0, 0, 1} : glm::vec3{0, 1, 0};
  add_arm(builder, scene, up, palette);

  const glm::vec3 well_foot = scene.inkwell_m + up * (scene.floor_height_m - glm::dot(scene.inkwell_m, up));
  builder.rod(Shape::cylinder, well_foot, scene.inkwell_m - 0.016f * up, 0.006f, palette.metal_dark, 0.2f);
  builder.rod(Shape::tapered, scene.inkwell_m - 0.004f * up, scene.inkwell_m - 0.020f * up, 0.013f, palette.metal_dark,
              0.3f);

  const float radius_m = std::max(scene.sphere_radius_m, smallest_drawn_sphere_m);
  builder.ball(scene.probe_m, radius_m, scene_colours::probe, 0.5f);

  if (glm::length(scene.force_N) > least_drawn_force_N) {
    const glm::vec3 tip = force_arrow_tip_m(scene);
    const glm::vec3 direction = glm::normalize(scene.force_N);
    const glm::vec3 neck = tip - std::min(0.014f, 0.5f * glm::length(tip - scene.probe_m)) * direction;
    builder.rod(Shape::cylinder, scene.probe_m, neck, 0.0022f, scene_colours::force, 0.2f);
    builder.without_shadow();
    builder.rod(Shape::cone, neck, tip, 0.0058f, scene_colours::force, 0.2f);
    builder.without_shadow();
  }
  if (hand) {
    if (glm::length(hand->target_m - scene.probe_m) > least_drawn_pull_m) {
      builder.rod(Shape::coil, scene.probe_m, hand->target_m, 0.0036f, scene_colours::hand, 0.3f);
      builder.without_shadow();
    }
    builder.ball(hand->target_m, hand->held ? 0.0042f : 0.0030f, scene_colours::hand, 0.3f);
    builder.without_shadow();
  }
  if (scene.in_contact) {
    builder.ball(scene.proxy_m, radius_m * 1.02f, scene_colours::proxy.with_alpha(150), 0.6f);
    builder.without_shadow();
  }
  return builder.take();
}

}  // namespace inkwell::window
