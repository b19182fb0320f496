// The few widgets that ImGui lacks, and those of ImGui's that an inspection knows by name.
#pragma once

#include <string>
#include <string_view>

#include <frame/style.hpp>

namespace inkwell::window {

/// Text in another colour or font.
void text(Colour colour, std::string_view content);
void text(ImFont* font, Colour colour, std::string_view content);
void wrapped_text(Colour colour, std::string_view content);
/// Text whose right end is at the cursor's x plus `width`.
void right_text(Colour colour, std::string_view content, float width);

/// The text, with an ellipsis where it does not fit; the current font unless one is given.
std::string fitted(std::string_view content, float width, ImFont* font = nullptr);

/// A triangle with an exclamation mark, for what must not be told by colour alone. Returns the width it takes.
float warning_sign(ImVec2 corner, Colour colour, const Style& style);

/// While the last item has the keyboard, the arrows up and down are its own and do not go to the next item.
void keep_vertical_arrows();

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

/// ImGui::BeginCombo of this width, whose text ends in an ellipsis where it does not fit.
bool begin_combo(const char* label, std::string_view shown, float width, ImGuiComboFlags flags = 0);

/// A window that fills a rectangle and can be neither moved nor closed. It has no ground of its own: the frame is
/// cleared to the panes' colour, which is cheaper than painting every pixel.
bool begin_pane(const char* name, ImVec2 place, ImVec2 size, ImGuiWindowFlags flags = 0);
/// The same, in front of those.
bool begin_top_pane(const char* name, ImVec2 place, ImVec2 size, ImGuiWindowFlags flags = 0);
void end_pane();

/// A handle between two panes; returns by how many points it was dragged, to the right or down.
float splitter(const char* name, ImVec2 place, ImVec2 size, bool vertical, const Style& style);

}  // namespace inkwell::window
