// Fonts, colours and spacing of ImGui, and the few widgets that it lacks.
#pragma once

#include <string>
#include <string_view>

#include <imgui.h>

#include <frame/palette.hpp>

namespace inkwell::window {

struct Fonts {
  ImFont* body;
  ImFont* strong;   ///< headings, state
  ImFont* caption;  ///< units, axes
};

struct Style {
  const Palette* palette;
  Fonts fonts;
  float scale;  ///< pixels for one point

  float points(float count) const { return count * scale; }
};

/// Inter if it is installed, else DejaVu, else ImGui's own font.
Fonts load_fonts(float scale);

void apply_theme(const Palette& palette, float scale);

constexpr ImU32 packed(Colour colour) { return IM_COL32(colour.red, colour.green, colour.blue, colour.alpha); }
ImVec4 vector(Colour colour);

/// Text in another colour or font.
void text(Colour colour, std::string_view content);
void text(ImFont* font, Colour colour, std::string_view content);
void wrapped_text(Colour colour, std::string_view content);
/// Text whose right end is at the cursor's x plus `width`.
void right_text(Colour colour, std::string_view content, float width);

/// A triangle with an exclamation mark, for what must not be told by colour alone. Returns the width it takes.
float warning_sign(ImVec2 corner, Colour colour, const Style& style);

/// True while a dialog darkens the rest of the window.
bool is_dialog_open();

/// The next item of this width goes beside the last one if there is room, else below.
void same_line_if_room(float width);

/// Explains the last item after the mouse has rested on it.
void help_on_hover(std::string_view title, std::string_view help, const Style& style);

/// A button of ImGui, with a name for inspections as all that follow.
bool button(const char* label, ImVec2 size = {0, 0});
/// A button without a frame until the mouse is over it.
bool quiet_button(const char* label, const Style& style);
/// A button in a colour of its own, such as the stop button.
bool coloured_button(const char* label, Colour colour, Colour text_colour, ImVec2 size);
/// A button that shows that it is on.
bool toggle_button(const char* label, bool on, const Style& style, ImVec2 size = {0, 0});

/// A slider whose field fills up to its value, with the value written in it. Ctrl and click types a value.
bool bar_slider(const char* label, float& value, float minimum, float maximum, const char* format,
                ImGuiSliderFlags flags, float width, const Style& style);

/// A window that fills a rectangle and can be neither moved nor closed. It has no ground of its own: the frame is
/// cleared to the panels' colour, which is cheaper than painting every pixel.
bool begin_pane(const char* name, ImVec2 place, ImVec2 size, ImGuiWindowFlags flags = 0);
void end_pane();

}  // namespace inkwell::window
