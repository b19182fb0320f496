// Widgets that ImGui lacks, and ImGui widgets with names for inspections.
#pragma once

#include <string>
#include <string_view>

#include <frame/style.hpp>

namespace inkwell::window {

void text(Colour colour, std::string_view content);
void text(ImFont* font, Colour colour, std::string_view content);
void wrapped_text(Colour colour, std::string_view content);
/// Text whose right end is at the cursor's x plus `width`.
void right_text(Colour colour, std::string_view content, float width);

/// The text, shortened with an ellipsis if it does not fit; uses the current font by default.
std::string fitted(std::string_view content, float width, ImFont* font = nullptr);

/// A triangle with an exclamation mark, so that a warning is not shown by color alone. Returns its width.
float warning_sign(ImVec2 corner, Colour colour, const Style& style);

/// While the last item has the focus, the up and down arrow keys act on this item and do not move the focus.
void keep_vertical_arrows();

/// True while a dialog dims the rest of the window.
bool is_dialog_open();

/// Puts the next item of this width on the same line if there is room, otherwise below.
void same_line_if_room(float width);

/// Shows an explanation of the last item after the mouse has rested on it.
void help_on_hover(std::string_view title, std::string_view help, const Style& style);

/// An ImGui button with a name for inspections. All following widgets also have one.
bool button(const char* label, ImVec2 size = {0, 0});
/// A button whose frame is visible only under the mouse.
bool quiet_button(const char* label, const Style& style);
/// A button in a custom color, such as the stop button.
bool coloured_button(const char* label, Colour colour, Colour text_colour, ImVec2 size);
/// A button that shows whether it is on.
bool toggle_button(const char* label, bool on, const Style& style, ImVec2 size = {0, 0});

/// ImGui::BeginCombo with this width; long text ends in an ellipsis.
bool begin_combo(const char* label, std::string_view shown, float width, ImGuiComboFlags flags = 0);

/// A window that fills a rectangle and cannot be moved or closed. It draws no background: clearing the framebuffer to
/// the pane color is faster than painting every pixel.
bool begin_pane(const char* name, ImVec2 place, ImVec2 size, ImGuiWindowFlags flags = 0);
/// The same, in front of the other panes.
bool begin_top_pane(const char* name, ImVec2 place, ImVec2 size, ImGuiWindowFlags flags = 0);
void end_pane();

/// A handle between two panes. Returns the drag distance in points, to the right or down.
float splitter(const char* name, ImVec2 place, ImVec2 size, bool vertical, const Style& style);

}  // namespace inkwell::window
