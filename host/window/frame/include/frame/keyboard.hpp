// The keyboard's way through the window: from part to part by Ctrl+Tab, inside a part by the arrows, which is ImGui's
// own; with a modifier the arrows move what the part shows.
#pragma once

#include <string>
#include <utility>

#include <imgui.h>

#include <frame/imgui_versions.hpp>
#include <frame/style.hpp>

struct ImGuiWindow;

namespace inkwell::window {

/// Which part has the keyboard: Ctrl+Tab gives it to the part that is drawn after the one that has it, with Shift
/// before it, and round; to the thing in it that had the keyboard last. Not while a dialog or a menu is open.
class KeyboardTour {
 public:
  /// To the part of that name, once it is drawn; "" leaves it where it is.
  void go_to(std::string part) { wanted_ = std::move(part); }
  /// To the next part in the next frame.
  void go_on(bool backwards) { steps_ += backwards ? -1 : 1; }
  /// Between ImGui's NewFrame() and the first part.
  void begin_frame();
  /// After the last part: a frame around the one that has the keyboard, as long as it is the keyboard that is used.
  void end_frame(const Style& style);

 private:
  void go_on_now(bool backwards);
  void give_to(ImGuiWindow& part);

  std::string wanted_;
  int steps_ = 0;                    ///< parts to go on, negative for backwards
  bool last_thing_is_gone_ = false;  ///< the first one then gets the keyboard
};

/// Whether the last item was pressed by the keyboard, not by the mouse.
bool is_pressed_by_keyboard();

/// How often each way was pressed in this frame.
struct KeySteps {
  int right = 0, up = 0, away = 0;  ///< the arrows; Page Up goes away from the user
  bool any() const { return right != 0 || up != 0 || away != 0; }
};
/// Of the keys that were pressed with exactly these modifiers while no text is typed and no dialog is open.
KeySteps key_steps(KeyModifiers modifiers);
/// The same for the current part alone: zero unless it has the keyboard.
KeySteps key_steps_in_part(KeyModifiers modifiers);
/// An arrow that is pressed with a modifier is no step to another thing. Between NewFrame() and the first part.
void keep_modified_arrows();

/// Page Up and Page Down scroll the current child, in which nothing can have the keyboard, if its part has it.
void scroll_by_page_keys();

}  // namespace inkwell::window
