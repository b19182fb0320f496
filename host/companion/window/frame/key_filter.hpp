// Filters the keys for ImGui. ImGui must receive neither Ctrl+Tab nor the keys that stop the force.
#pragma once

namespace inkwell::window {

/// A key event from GLFW.
struct KeyEvent {
  int key;        ///< GLFW_KEY_...
  int scancode;   ///< platform-specific
  int action;     ///< GLFW_PRESS, GLFW_RELEASE or GLFW_REPEAT
  int modifiers;  ///< GLFW_MOD_...
};

inline constexpr int space_bar = 32;                            // GLFW_KEY_SPACE
inline constexpr int escape_key = 256;                          // GLFW_KEY_ESCAPE
inline constexpr int tab_key = 258;                             // GLFW_KEY_TAB
inline constexpr int key_release = 0;                           // GLFW_RELEASE
inline constexpr int shift_modifier = 1, control_modifier = 2;  // GLFW_MOD_...

/// Returns true for a press of Ctrl+Tab or Ctrl+Shift+Tab. These keys move the keyboard focus between panes.
constexpr bool is_next_part(const KeyEvent& event) {
  return event.key == tab_key && event.action != key_release && (event.modifiers & control_modifier) != 0;
}

/// Returns true if ImGui may receive the event. The filter blocks the space bar, because text fields receive characters
/// separately. The filter blocks Ctrl+Tab, because ImGui could detect Tab without Ctrl in a long frame. `can_cancel` is
/// true while a control is in use, or a dialog or menu is open. If `can_cancel` is false, the filter blocks the press
/// of Escape, because Escape would clear the keyboard focus. The filter never blocks the release of Escape.
constexpr bool is_for_imgui(const KeyEvent& event, bool can_cancel) {
  if (event.key == space_bar || is_next_part(event)) return false;
  return event.key != escape_key || event.action == key_release || can_cancel;
}

}  // namespace inkwell::window
