// Additional widgets, and ImGui widgets with names for inspections.
#pragma once

#include <string>
#include <string_view>

#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

/// Smallest width and height of an item that the mouse operates (WCAG 2.2, 2.5.8).
inline constexpr float target_points = 24.0f;

void text(Colour colour, std::string_view content);
void text(ImFont* font, Colour colour, std::string_view content);
void wrapped_text(Colour colour, std::string_view content);
/// Draws right-aligned text. `width` is the distance from the cursor to the right end of the text.
void right_text(Colour colour, std::string_view content, float width);

/// Returns the text, shortened with an ellipsis if necessary. Default: the current font.
std::string fitted(std::string_view content, float width, ImFont* font = nullptr);

/// Draws a warning triangle and returns the triangle's width.
float warning_sign(ImVec2 corner, Colour colour, const Style& style);

/// Prevents the up and down arrow keys from moving the focus away from the last item.
void keep_vertical_arrows();

/// Returns true while a dialog is open.
bool is_dialog_open();

/// Starts a new line if the current line has less than `width` left.
void same_line_if_room(float width);

/// Shows a tooltip while the mouse hovers over the last item. While the user types text, no tooltip covers the fields.
void help_on_hover(std::string_view title, std::string_view help, const Style& style);

/// An ImGui button with a name for inspections.
bool button(const char* label, ImVec2 size = {0, 0});
/// A flat button. The background appears while the mouse hovers over the button.
bool quiet_button(const char* label, const Style& style);
/// A button in a custom color, such as the stop button.
bool coloured_button(const char* label, Colour colour, Colour text_colour, ImVec2 size);
/// A button for an action that loses data. The text is red, because only STOP has a red fill.
bool grave_button(const char* label, const Style& style, ImVec2 size);
/// The button for the next action of the user. At most one button of a pane is a primary button.
bool primary_button(const char* label, const Style& style, ImVec2 size = {0, 0});
/// A button with a visible on/off state. A line under the text marks the state "on".
bool toggle_button(const char* label, bool on, const Style& style, ImVec2 size = {0, 0});
/// A tab without a frame. A line under the text marks the selected tab. With `hides_label`, the caller draws the text.
bool tab_button(const char* label, bool is_selected, const Style& style, ImVec2 size, bool hides_label = false);

/// Marks the last item with an outline and shows a message below the item, in front of all panes. Other items do not
/// move. Returns true if the user clicks the message.
bool message_below_item(const char* name, Colour colour, std::string_view message, const Style& style);
/// Shows a message in front of the lower end of the current window. Returns true if the user clicks the message.
bool message_at_bottom(const char* name, float bottom, Colour colour, std::string_view message, const Style& style);

/// Calls ImGui::BeginCombo() with this width. An ellipsis replaces the end of long text.
bool begin_combo(const char* label, std::string_view shown, float width, ImGuiComboFlags flags = 0);

/// Begins a window that fills a rectangle and cannot be moved or closed. The window has no background, because the
/// cleared framebuffer already has the pane color.
bool begin_pane(const char* name, ImVec2 origin, ImVec2 size, ImGuiWindowFlags flags = 0);
/// Begins a pane in front of the other panes.
bool begin_top_pane(const char* name, ImVec2 origin, ImVec2 size, ImGuiWindowFlags flags = 0);
void end_pane();

/// Draws a handle between two panes. Returns the drag distance to the right or down, in points.
float splitter(const char* name, ImVec2 origin, ImVec2 size, bool vertical, const Style& style);

}  // namespace inkwell::window
