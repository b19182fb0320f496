// A field for a number. Typed text has no effect until the user confirms the text.
#pragma once

#include <optional>
#include <string>

#include <imgui.h>

#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/frame/value_range.hpp"

namespace inkwell::window {

/// User actions on a field in one frame.
struct ValueEdit {
  bool drag_begins = false;
  std::optional<float> dragged_to;
  bool drag_ends = false;
  std::optional<std::string> typed;  ///< the new text, confirmed by Enter or by leaving the field
};

/// The number fields of one pane. The user edits at most one field at a time.
class ValueFields {
 public:
  /// Draws a field with a drag handle and a number. The filled part of the background shows the value within its range.
  /// Dragging changes the value, ten times faster with Shift and ten times slower with Ctrl. Escape restores the
  /// previous text. In inspections, the handle has the name "<name> handle".
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
  std::optional<Typing> left_;  ///< in a field that has lost the focus to a field that was already drawn in this frame
  float drag_start_ = 0;
  float dragged_points_ = 0;
};

}  // namespace inkwell::window
