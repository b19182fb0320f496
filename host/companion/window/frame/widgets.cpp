#include "host/companion/window/frame/widgets.hpp"

#include <algorithm>

#include <imgui_internal.h>

#include "host/companion/window/frame/ellipsis.hpp"
#include "host/companion/window/frame/inspection.hpp"

namespace inkwell::window {

void text(Colour colour, std::string_view content) {
  note_text(content);
  need_glyphs(content);
  ImGui::PushStyleColor(ImGuiCol_Text, packed(colour));
  ImGui::TextUnformatted(content.data(), content.data() + content.size());
  ImGui::PopStyleColor();
}

void text(ImFont* font, Colour colour, std::string_view content) {
  ImGui::PushFont(font);
  text(colour, content);
  ImGui::PopFont();
}

void wrapped_text(Colour colour, std::string_view content) {
  ImGui::PushTextWrapPos(0.0f);
  text(colour, content);
  ImGui::PopTextWrapPos();
}

void right_text(Colour colour, std::string_view content, float width) {
  const float taken = ImGui::CalcTextSize(content.data(), content.data() + content.size()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, width - taken));
  text(colour, content);
}

std::string fitted(std::string_view content, float width, ImFont* font) {
  need_glyphs(content);
  if (font == nullptr) font = ImGui::GetFont();
  const auto width_of = [font](std::string_view part) {
    constexpr float without_end = 1e4f;
    return font->CalcTextSizeA(font->FontSize, without_end, 0, part.data(), part.data() + part.size()).x;
  };
  return with_ellipsis(content, width, width_of);
}

float warning_sign(ImVec2 corner, Colour colour, const Style& style) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float size = style.points(14);
  const float middle = corner.x + 0.5f * size;
  const float top = corner.y + style.points(3);
  list.AddTriangleFilled({middle, top}, {corner.x + size, top + 0.9f * size}, {corner.x, top + 0.9f * size},
                         packed(colour));
  const ImU32 mark = packed(style.palette->pane);
  list.AddLine({middle, top + 0.33f * size}, {middle, top + 0.6f * size}, mark, style.points(1.6f));
  list.AddCircleFilled({middle, top + 0.74f * size}, style.points(1.0f), mark);
  return size + style.points(4);
}

void keep_vertical_arrows() {
  if (ImGui::IsItemActive())
    ImGui::GetCurrentContext()->ActiveIdUsingNavDirMask |= (1u << ImGuiDir_Up) | (1u << ImGuiDir_Down);
}

bool is_dialog_open() { return ImGui::GetTopMostPopupModal() != nullptr; }

void same_line_if_room(float width) {
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width <= right) ImGui::SameLine();
}

void help_on_hover(std::string_view title, std::string_view help, const Style& style) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) || ImGui::IsItemActive()) return;
  if (ImGui::GetIO().WantTextInput) return;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(11), style.points(9)});
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(style.points(300));
  if (!title.empty()) text(style.fonts.strong, style.palette->text, title);
  text(style.palette->text_quiet, help);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

bool button(const char* label, ImVec2 size) {
  need_glyphs(label);
  const bool pressed = ImGui::Button(label, size);
  note_item(label);
  return pressed;
}

bool quiet_button(const char* label, const Style& style) {
  ImGui::PushStyleColor(ImGuiCol_Button, packed(style.palette->pane.with_alpha(0)));
  ImGui::PushStyleColor(ImGuiCol_Text, packed(style.palette->text_quiet));
  const bool pressed = button(label);
  ImGui::PopStyleColor(2);
  return pressed;
}

bool coloured_button(const char* label, Colour colour, Colour text_colour, ImVec2 size) {
  ImGui::PushStyleColor(ImGuiCol_Button, packed(colour));
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, packed(lighter(colour, hover_lightening)));
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, packed(lighter(colour, -hover_lightening)));
  ImGui::PushStyleColor(ImGuiCol_Text, packed(text_colour));
  const bool pressed = button(label, size);
  ImGui::PopStyleColor(4);
  return pressed;
}

bool grave_button(const char* label, const Style& style, ImVec2 size) {
  return coloured_button(label, style.palette->raised, style.palette->danger_text, size);
}

bool primary_button(const char* label, const Style& style, ImVec2 size) {
  return coloured_button(label, style.palette->accent, style.palette->pane, size);
}

namespace {

// Draws a line at the lower edge of the last item.
void underline_item(Colour colour, const Style& style) {
  const ImVec2 corner = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
  const float margin = style.points(6), thickness = style.points(2.5f);
  ImGui::GetWindowDrawList()->AddRectFilled({corner.x + margin, end.y - thickness - style.points(1)},
                                            {end.x - margin, end.y - style.points(1)}, packed(colour));
}

}  // namespace

bool toggle_button(const char* label, bool on, const Style& style, ImVec2 size) {
  if (!on) return button(label, size);
  const bool pressed = coloured_button(label, style.palette->raised_active, style.palette->text, size);
  underline_item(style.palette->accent, style);
  return pressed;
}

bool tab_button(const char* label, bool is_selected, const Style& style, ImVec2 size, bool hides_label) {
  const Palette& palette = *style.palette;
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_Button, packed(palette.pane.with_alpha(0)));
  ImGui::PushStyleColor(ImGuiCol_Text,
                        packed((is_selected ? palette.text : palette.text_quiet).with_alpha(hides_label ? 0 : 255)));
  const bool pressed = button(label, size);
  ImGui::PopStyleColor(2);
  ImGui::PopStyleVar();
  if (is_selected) underline_item(palette.accent, style);
  return pressed;
}

namespace {

bool draw_message(const char* name, ImVec2 position, float pivot_y, float width, Colour colour,
                  std::string_view message, const Style& style) {
  ImGui::SetNextWindowPos(position, ImGuiCond_Always, {0.0f, pivot_y});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, style.points(6));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, style.points(1.5f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(10), style.points(8)});
  ImGui::PushStyleColor(ImGuiCol_Border, packed(colour));
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  wrapped_text(style.palette->text, message);
  const bool is_clicked = ImGui::IsWindowHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
  note_area("message", ImGui::GetWindowPos(),
            {ImGui::GetWindowPos().x + ImGui::GetWindowSize().x, ImGui::GetWindowPos().y + ImGui::GetWindowSize().y});
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(3);
  return is_clicked;
}

}  // namespace

bool message_below_item(const char* name, Colour colour, std::string_view message, const Style& style) {
  const ImVec2 corner = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
  ImGui::GetWindowDrawList()->AddRect(corner, end, packed(colour), ImGui::GetStyle().FrameRounding, 0, style.points(2));
  const ImGuiWindow& pane = *ImGui::GetCurrentWindow()->RootWindow;
  const float margin = style.points(10), width = pane.Size.x - 2 * margin, gap = style.points(4);
  const float height =
      ImGui::CalcTextSize(message.data(), message.data() + message.size(), false, width - 2 * margin).y + 2 * margin;
  const bool fits_below = end.y + gap + height <= ImGui::GetIO().DisplaySize.y;
  return draw_message(name, {pane.Pos.x + margin, fits_below ? end.y + gap : corner.y - gap}, fits_below ? 0.0f : 1.0f,
                      width, colour, message, style);
}

bool message_at_bottom(const char* name, float bottom, Colour colour, std::string_view message, const Style& style) {
  const ImGuiWindow& pane = *ImGui::GetCurrentWindow()->RootWindow;
  const float margin = style.points(10);
  return draw_message(name, {pane.Pos.x + margin, bottom}, 1.0f, pane.Size.x - 2 * margin, colour, message, style);
}

bool begin_combo(const char* label, std::string_view shown, float width, ImGuiComboFlags flags) {
  const float arrow = ImGui::GetFrameHeight();
  ImGui::SetNextItemWidth(width);
  const float room = width - arrow - 2.0f * ImGui::GetStyle().FramePadding.x;
  const bool is_open = ImGui::BeginCombo(label, fitted(shown, room).c_str(), flags);
  if (!is_open) note_item(label);
  return is_open;
}

bool begin_pane(const char* name, ImVec2 origin, ImVec2 size, ImGuiWindowFlags flags) {
  return begin_top_pane(name, origin, size, ImGuiWindowFlags_NoBringToFrontOnFocus | flags);
}

bool begin_top_pane(const char* name, ImVec2 origin, ImVec2 size, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos(origin);
  ImGui::SetNextWindowSize(size);
  return ImGui::Begin(name, nullptr,
                      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                          ImGuiWindowFlags_NoBackground | flags);
}

void end_pane() { ImGui::End(); }

float splitter(const char* name, ImVec2 origin, ImVec2 size, bool vertical, const Style& style) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2{1, 1});
  // The sensitive area is wider than the drawn line.
  const float more = std::max(0.0f, 0.5f * (style.points(target_points) - (vertical ? size.x : size.y)));
  const ImVec2 around{vertical ? more : 0.0f, vertical ? 0.0f : more};
  const ImVec2 sensitive{size.x + 2 * around.x, size.y + 2 * around.y};
  begin_pane(name, {origin.x - around.x, origin.y - around.y}, sensitive,
             ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::InvisibleButton("handle", sensitive);
  note_item("handle");
  const bool lively = ImGui::IsItemHovered() || ImGui::IsItemActive();
  if (lively) ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  ImGui::GetWindowDrawList()->AddRectFilled(origin, {origin.x + size.x, origin.y + size.y},
                                            packed(lively ? style.palette->accent : style.palette->ground));
  const ImVec2 moved = ImGui::IsItemActive() ? ImGui::GetIO().MouseDelta : ImVec2{0, 0};
  end_pane();
  ImGui::PopStyleVar(2);
  return (vertical ? moved.x : moved.y) / style.scale;
}

}  // namespace inkwell::window
