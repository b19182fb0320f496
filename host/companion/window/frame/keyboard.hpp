// Keyboard navigation in the window. Ctrl+Tab moves the focus between panes, and the arrow keys move the focus within a
// pane. With a modifier, the arrow keys move the content of a pane.
#pragma once

#include <string>
#include <utility>

#include <imgui.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/style.hpp"

struct ImGuiWindow;

namespace inkwell::window {

/// Moves the keyboard focus through the panes in drawing order. In each pane, the last focused item receives the focus
/// again. The focus does not move while a dialog or menu is open.
class KeyboardTour {
 public:
  /// In the next frame, moves the focus to the pane with this name. An empty name does not change the focus.
  void go_to(std::string part) { wanted_ = std::move(part); }
  /// In the next frame, moves the focus to the next or previous pane.
  void go_on(bool backwards) { steps_ += backwards ? -1 : 1; }
  /// Call between ImGui::NewFrame() and the first pane.
  void begin_frame();
  /// Draws a border around the focused pane during keyboard use. Call after the last pane.
  void end_frame(const Style& style);

 private:
  void go_on_now(bool backwards);
  void focus_window(ImGuiWindow& part);

  std::string wanted_;
  int steps_ = 0;                    ///< number of panes to move forward; negative: backward
  bool last_thing_is_gone_ = false;  ///< then the first item receives the focus
};

/// Returns true if the keyboard, not the mouse, activated the last item.
bool is_pressed_by_keyboard();

/// Number of key presses in each direction in this frame.
struct KeySteps {
  int right = 0, up = 0, away = 0;  ///< arrow keys; Page Up counts as away from the user
  bool any() const { return right != 0 || up != 0 || away != 0; }
};
/// Counts the key presses with exactly these modifiers. Returns zeros while a text field is edited or a dialog is open.
KeySteps key_steps(KeyModifiers modifiers);
/// Returns key_steps() if the current pane has the focus, and zeros otherwise.
KeySteps key_steps_in_part(KeyModifiers modifiers);
/// Prevents arrow keys with a modifier from moving the focus. Call between ImGui::NewFrame() and the first pane.
void keep_modified_arrows();

/// Lets Page Up and Page Down scroll a child window without focusable items.
void scroll_by_page_keys();

}  // namespace inkwell::window
