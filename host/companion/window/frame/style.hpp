// Fonts, colors and spacing for ImGui.
#pragma once

#include <imgui.h>

#include "host/companion/window/frame/palette.hpp"

namespace inkwell::window {

struct Fonts {
  ImFont* body;
  ImFont* strong;   ///< headings, state
  ImFont* caption;  ///< units, axes
};

struct Style {
  const Palette* palette;
  Fonts fonts;
  float scale;  ///< pixels per point

  float points(float count) const { return count * scale; }
};

/// Loads the first available font: Inter, DejaVu or ImGui's built-in font.
Fonts load_fonts(float scale);

void apply_theme(const Palette& palette, float scale);

constexpr ImU32 packed(Colour colour) { return IM_COL32(colour.red, colour.green, colour.blue, colour.alpha); }
ImVec4 vector(Colour colour);

}  // namespace inkwell::window
