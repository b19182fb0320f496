// A field for a number that affects a machine: typed text has no effect until it is confirmed.
#pragma once

#include <optional>
#include <string>

#include <imgui.h>

#include <frame/style.hpp>
#include <frame/value_range.hpp>

namespace inkwell::window {

/// The user's actions on a field in this frame.
struct ValueEdit {
  bool drag_begins = false;
  std::optional<float> dragged_to;
  bool drag_ends = false;
  std::optional<std::string> typed;  ///< the new text, confirmed by Enter or by leaving the field
};

/// The fields of one pane. At most one of them is edited at a time.
class ValueFields {
 public:
  /// A field with a drag handle on the left and a number that a click selects. Its background is filled up to the
  /// position of the value in the range. Dragging the handle changes the value, with Shift ten times as fast and with
  /// Ctrl a tenth as fast. Escape restores the text before typing. `name`: for inspections; the handle is "<name>
  /// handle".
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

  std::optional<Typing> typing_;  ///< in the field with the keyboard focus
  std::optional<Typing> left_;    ///< in the field that lost the focus to a field above it in this frame; kept until
                                  ///< that field is drawn
  float drag_start_ = 0;
  float dragged_points_ = 0;
};

}  // namespace inkwell::window
