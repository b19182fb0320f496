// Fonts, colors and spacing for ImGui.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <imgui.h>

#include "host/companion/window/frame/glyph_needs.hpp"
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
  float scale;  ///< screen units per point

  float points(float count) const { return count * scale; }
};

/// Loads the first available font: Inter, DejaVu or ImGui's built-in font. Later adds the characters of displayed texts
/// from all installed fonts, in a separate thread, so that no frame waits. The pictures of the characters have the
/// resolution of the display, also after the window was moved to another display.
class FontLoader {
 public:
  explicit FontLoader(float scale);
  ~FontLoader();
  FontLoader(const FontLoader&) = delete;
  FontLoader& operator=(const FontLoader&) = delete;

  const Fonts& fonts() const { return fonts_; }
  /// Call before ImGui::NewFrame(). Returns true if the fonts have changed. Pixels per screen unit are those of ImGui.
  bool update();
  /// Returns true while a font atlas with more characters is being prepared.
  bool is_loading() const { return next_ != nullptr; }
  /// Number of displayed characters that no loaded font contains.
  std::size_t missing() const;

 private:
  struct Next;
  float scale_;
  float pixels_per_unit_;
  Fonts fonts_;
  std::size_t tried_count_ = 0;  ///< number of recorded characters at the last search
  std::unique_ptr<Next> next_;
};

void apply_theme(const Palette& palette, float scale);

constexpr ImU32 packed(Colour colour) { return IM_COL32(colour.red, colour.green, colour.blue, colour.alpha); }
ImVec4 vector(Colour colour);

}  // namespace inkwell::window
