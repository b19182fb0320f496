// The solid bodies of the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "host/companion/window/frame/palette.hpp"
#include "host/companion/window/scene/scene_model.hpp"

namespace inkwell::window {

enum class Shape : std::uint8_t { sphere, cylinder, tapered, cone, coil };

struct Solid {
  Shape shape;
  glm::mat4 transform;  ///< in view space, meters
  Colour colour;
  float shininess = 0.25f;
  bool casts_shadow = true;
};

/// Simulated hand of the virtual board, in workspace axes.
struct HandView {
  glm::vec3 target_m;
  bool held;  ///< the mouse currently drags the hand
};

/// Returns all bodies in view space. Transparent bodies are last.
std::vector<Solid> solids_of(const SceneModel& scene, const std::optional<HandView>& hand, const Palette& palette);

/// Length of the force arrow per newton.
inline constexpr float force_arrow_m_per_N = 0.022f;
/// Returns the tip of the force arrow, in workspace axes.
glm::vec3 force_arrow_tip_m(const SceneModel& scene);

}  // namespace inkwell::window
