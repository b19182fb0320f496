#include "host/companion/window/frame/value_field.hpp"

#include <utility>

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

namespace {

constexpr float handle_points = 24.0f;
constexpr float fast = 10.0f;
constexpr float fine = 0.1f;

// Draws a drag handle with six dots.
void draw_grip(ImVec2 corner, ImVec2 size, Colour colour, const Style& style) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 centre{corner.x + 0.5f * size.x, corner.y + 0.5f * size.y};
  const float gap = style.points(4);
  for (int row = -1; row <= 1; ++row)
    for (const float side : {-0.5f, 0.5f})
      list.AddCircleFilled({centre.x + side * gap, centre.y + static_cast<float>(row) * gap}, style.points(1.1f),
                           packed(colour), 6);
}

void draw_ground(ImVec2 corner, ImVec2 end, float part, bool is_typed_in, const Style& style) {
  const Palette& palette = *style.palette;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = ImGui::GetStyle().FrameRounding;
  const bool hovered = ImGui::IsMouseHoveringRect(corner, end) && ImGui::IsWindowHovered();
  list.AddRectFilled(corner, end, packed(hovered ? palette.raised_hover : palette.raised), rounding);
  if (!is_typed_in) list.AddRect(corner, end, packed(palette.outline), rounding);
  if (is_typed_in) {
    list.AddRect(corner, end, packed(palette.accent), rounding, 0, style.points(1.5f));
    return;
  }
  const float edge = corner.x + part * (end.x - corner.x);
  if (edge - corner.x > 1.0f) {
    list.PushClipRect(corner, {edge, end.y}, true);
    list.AddRectFilled(corner, end, packed(palette.accent.with_alpha(hovered ? 105 : 78)), rounding);
    list.PopClipRect();
  }
  // The short line at the bottom marks the value without crossing the number.
  list.AddLine({edge, end.y - style.points(4)}, {edge, end.y}, packed(palette.accent), style.points(2));
}

}  // namespace

void ValueFields::follow_drag(float value, const ValueRange& range, const Style& style, ValueEdit& edit) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemActivated()) {
    edit.drag_begins = true;
    drag_start_ = value;
    dragged_points_ = 0;
  }
  if (ImGui::IsItemActive() && io.MouseDelta.x != 0) {
    dragged_points_ += io.MouseDelta.x / style.scale * (io.KeyShift ? fast : io.KeyCtrl ? fine : 1.0f);
    edit.dragged_to = range.dragged(drag_start_, dragged_points_);
  }
  edit.drag_ends = ImGui::IsItemDeactivated();
}

void ValueFields::follow_typing(const char* id, float value, const ValueRange& range, float width, ValueEdit& edit) {
  const ImGuiID field = ImGui::GetID(id);
  std::string shown = range.text_of(value);
  ImGui::SetNextItemWidth(width);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, ImVec4{0, 0, 0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0.0f);
  ImGui::InputText(id, is_typed_in(field) ? &typing_->text : &shown, ImGuiInputTextFlags_AutoSelectAll);
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  if (ImGui::IsItemActivated()) left_ = std::exchange(typing_, Typing{field, shown, shown});
  if (!ImGui::IsItemDeactivated()) return;
  auto& ended = is_typed_in(field) ? typing_ : left_;
  if (ended && ended->field == field && ended->text != ended->text_before) edit.typed = ended->text;
  ended.reset();
}

ValueEdit ValueFields::draw(const char* id, const std::string& name, float value, const ValueRange& range, float width,
                            const Style& style) {
  const Palette& palette = *style.palette;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetFrameHeight();
  draw_ground(corner, {corner.x + width, corner.y + height}, range.part_of(value), is_typed_in(ImGui::GetID(id)),
              style);
  ImGui::BeginGroup();
  ValueEdit edit;
  const ImVec2 handle{style.points(handle_points), height};
  ImGui::PushID(id);
  ImGui::PushItemFlag(ImGuiItemFlags_NoNav | ImGuiItemFlags_NoNavDefaultFocus, true);  // only the number has the focus
  ImGui::InvisibleButton("handle", handle);
  ImGui::PopItemFlag();
  ImGui::PopID();
  note_item(name + " handle");
  const bool lively = ImGui::IsItemHovered() || ImGui::IsItemActive();
  if (lively) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  follow_drag(value, range, style, edit);
  draw_grip(corner, handle, lively ? palette.text : palette.text_quiet, style);

  ImGui::SameLine(0, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{style.points(3), ImGui::GetStyle().FramePadding.y});
  follow_typing(id, value, range, width - handle.x, edit);
  ImGui::PopStyleVar();
  note_item(name);
  ImGui::EndGroup();
  return edit;
}

}  // namespace inkwell::window
