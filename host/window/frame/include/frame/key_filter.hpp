// Keys that ImGui must not see: the keys that stop the force, which would press the focused control or close something,
// and Ctrl+Tab.
#pragma once

namespace inkwell::window {

/// A key event as GLFW reports it.
struct KeyEvent {
  int key;        ///< GLFW_KEY_...
  int scancode;   ///< of the platform
  int action;     ///< GLFW_PRESS, GLFW_RELEASE or GLFW_REPEAT
  int modifiers;  ///< GLFW_MOD_...
};

inline constexpr int space_bar = 32;                            // GLFW_KEY_SPACE
inline constexpr int escape_key = 256;                          // GLFW_KEY_ESCAPE
inline constexpr int tab_key = 258;                             // GLFW_KEY_TAB
inline constexpr int key_release = 0;                           // GLFW_RELEASE
inline constexpr int shift_modifier = 1, control_modifier = 2;  // GLFW_MOD_...

/// True if the event gives the keyboard to another part of the window: Ctrl+Tab, with or without Shift.
constexpr bool is_next_part(const KeyEvent& event) {
  return event.key == tab_key && event.action != key_release && (event.modifiers & control_modifier) != 0;
}

/// True if ImGui may see the event. Never for the space bar: text fields receive its character separately. Never for
/// Ctrl+Tab: if Ctrl is released before Tab, ImGui would take a long frame for a repeated Tab. For Escape
/// only if `can_cancel`, that is, a control is in use or a dialog or menu is open. Otherwise Escape would take the
/// keyboard focus away. A release always passes, so that no key remains down for ImGui.
constexpr bool is_for_imgui(const KeyEvent& event, bool can_cancel) {
  if (event.key == space_bar || is_next_part(event)) return false;
  return event.key != escape_key || event.action == key_release || can_cancel;
}

}  // namespace inkwell::window
