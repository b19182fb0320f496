// The solid bodies of the scene, from the scene's model: what to draw, where and in which colour.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include <frame/palette.hpp>
#include <scene/scene_model.hpp>

namespace inkwell::window {

enum class Shape : std::uint8_t { sphere, cylinder, tapered, cone, coil };

struct Solid {
  Shape shape;
  glm::mat4 placement;  ///< in view space, metres
  Colour colour;
  float shininess = 0.25f;
  bool casts_shadow = true;
};

/// What the hand of the virtual board does, in workspace axes.
struct HandView {
  glm::vec3 target_m;
  bool held;  ///< by the mouse at this moment
};

/// Everything in metres of view space, opaque first; those with an alpha below 255 come last.
std::vector<Solid> solids_of(const SceneModel& scene, const std::optional<HandView>& hand, const Palette& palette);

/// Length of the force's arrow for one newton.
inline constexpr float force_arrow_m_per_N = 0.022f;
/// Where the arrow ends, in workspace axes.
glm::vec3 force_arrow_tip_m(const SceneModel& scene);

}  // namespace inkwell::window
