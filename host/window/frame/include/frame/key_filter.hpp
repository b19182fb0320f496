// The keys that stop the force must not reach ImGui, which would press the focused control with them or close
// something.
#pragma once

namespace inkwell::window {

/// A key event as GLFW reports it.
struct KeyEvent {
  int key;        ///< GLFW_KEY_...
  int scancode;   ///< of the platform
  int action;     ///< GLFW_PRESS, GLFW_RELEASE or GLFW_REPEAT
  int modifiers;  ///< GLFW_MOD_...
};

inline constexpr int space_bar = 32;    // GLFW_KEY_SPACE
inline constexpr int escape_key = 256;  // GLFW_KEY_ESCAPE
inline constexpr int key_release = 0;   // GLFW_RELEASE

/// True if ImGui may see the event. Never for the space bar: text fields receive its character separately. For Escape
/// only if `can_cancel`, that is, a control is in use or a dialog or menu is open. Otherwise Escape would take the
/// keyboard focus away. A release always passes, so that no key remains down for ImGui.
constexpr bool is_for_imgui(const KeyEvent& event, bool can_cancel) {
  if (event.key == space_bar) return false;
  return event.key != escape_key || event.action == key_release || can_cancel;
}

}  // namespace inkwell::window
