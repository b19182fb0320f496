// Keyboard navigation in the window. Ctrl+Tab moves between panes and the arrow keys move within a pane, which ImGui
// implements. With a modifier the arrow keys move the content of a pane.
#pragma once

#include <string>
#include <utility>

#include <imgui.h>

#include <frame/imgui_versions.hpp>
#include <frame/style.hpp>

struct ImGuiWindow;

namespace inkwell::window {

/// The pane with the keyboard focus. Ctrl+Tab moves the focus to the next pane in drawing order, with Shift to the
/// previous one, cyclically. The pane's last focused item gets the focus. Ctrl+Tab has no effect while a dialog or menu
/// is open.
class KeyboardTour {
 public:
  /// Moves the focus to the pane with this name when it is drawn. "" does not change the focus.
  void go_to(std::string part) { wanted_ = std::move(part); }
  /// Moves the focus to the next pane in the next frame.
  void go_on(bool backwards) { steps_ += backwards ? -1 : 1; }
  /// Call this between ImGui's NewFrame() and the first pane.
  void begin_frame();
  /// Call this after the last pane. Draws a frame around the focused pane while the user uses the keyboard.
  void end_frame(const Style& style);

 private:
  void go_on_now(bool backwards);
  void give_to(ImGuiWindow& part);

  std::string wanted_;
  int steps_ = 0;                    ///< panes to move by; negative: backwards
  bool last_thing_is_gone_ = false;  ///< the first item then gets the focus
};

/// Whether the last item was activated by the keyboard instead of the mouse.
bool is_pressed_by_keyboard();

/// Number of key presses in each direction in this frame.
struct KeySteps {
  int right = 0, up = 0, away = 0;  ///< arrow keys; Page Up counts as away from the user
  bool any() const { return right != 0 || up != 0 || away != 0; }
};
/// Counts keys that were pressed with exactly these modifiers while no text is typed and no dialog is open.
KeySteps key_steps(KeyModifiers modifiers);
/// The same for the current pane; zero unless it has the focus.
KeySteps key_steps_in_part(KeyModifiers modifiers);
/// Arrow keys with a modifier do not move the focus. Call this between NewFrame() and the first pane.
void keep_modified_arrows();

/// Page Up and Page Down scroll the current child window, which has no focusable items, if its pane has the focus.
void scroll_by_page_keys();

}  // namespace inkwell::window
