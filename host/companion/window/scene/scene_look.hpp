// Viewport and style of the scene.
#pragma once

#include <optional>

#include "host/companion/window/frame/palette.hpp"

namespace inkwell::window {

/// Part of the framebuffer in pixels. The origin is at the bottom left, as in OpenGL.
struct Viewport {
  int x, y, width, height;
};

struct SceneLook {
  const Palette& palette;
  bool flat_colours;               ///< no lighting; wall frames are opaque
  bool smooth;                     ///< multisampling, which is slow without a graphics card
  bool is_as_before;               ///< the scene has not changed since the last call
  std::optional<int> marked_wall;  ///< wall under the mouse: index into SceneModel::walls
};

}  // namespace inkwell::window
