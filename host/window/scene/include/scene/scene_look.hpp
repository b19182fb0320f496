// How and where the scene is drawn.
#pragma once

#include <optional>

#include <frame/palette.hpp>

namespace inkwell::window {

/// Part of the framebuffer in pixels, origin bottom left as in OpenGL.
struct Viewport {
  int x, y, width, height;
};

struct SceneLook {
  const Palette& palette;
  bool flat_colours;               ///< no lighting, frames of the walls opaque
  bool smooth;                     ///< with multisampling, in a buffer of its own: dear without a graphics card
  bool is_as_before;               ///< the same scene as in the last call, which need not be drawn anew
  std::optional<int> marked_wall;  ///< under the mouse: index into SceneModel::walls
};

}  // namespace inkwell::window
