// A field for a number that acts on a machine: typing changes nothing until it is finished.
#pragma once

#include <optional>
#include <string>

#include <imgui.h>

#include <frame/style.hpp>
#include <frame/value_range.hpp>

namespace inkwell::window {

/// What the user did with a field in this frame.
struct ValueEdit {
  bool drag_begins = false;
  std::optional<float> dragged_to;
  bool drag_ends = false;
  std::optional<std::string> typed;  ///< another text than before, finished by Enter or by leaving the field
};

/// The fields of one pane, of which at most one is edited.
class ValueFields {
 public:
  /// A field with a handle at its left and a number that a click selects. Its ground fills up to the value's place in
  /// the range. Dragging the handle changes the value, with Shift ten times as fast and with Ctrl a tenth; Escape gives
  /// back what was there before typing. `name`: for inspections, which know the handle as "<name> handle".
  ValueEdit draw(const char* id, const std::string& name, float value, const ValueRange& range, float width,
                 const Style& style);

 private:
  void follow_drag(float value, const ValueRange& range, const Style& style, ValueEdit& edit);
  void follow_typing(const char* id, float value, const ValueRange& range, float width, ValueEdit& edit);

  struct Typing {
    ImGuiID field;
    std::string text;
    std::string text_before;
  };
  bool is_typed_in(ImGuiID field) const { return typing_ && typing_->field == field; }

  std::optional<Typing> typing_;  ///< in the field that has the keyboard
  std::optional<Typing> left_;    ///< in the one that lost it to a field above in this frame, until that one is drawn
  float drag_start_ = 0;
  float dragged_points_ = 0;
};

}  // namespace inkwell::window
