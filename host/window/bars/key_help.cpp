#include <bars/key_help.hpp>

#include <string_view>
#include <utility>

#include <frame/widgets.hpp>

namespace inkwell::window {

namespace {

struct Row {
  std::string_view what_one_does;
  std::string_view what_happens;  ///< empty: what stands before is a heading
};

constexpr Row rows[] = {
    {"Force", ""},
    {"Escape, F12", "Switch the force off, always"},
    {"Space", "The same, except while a text is typed"},
    {"Values", ""},
    {"Click a number", "Type another one"},
    {"Enter, or a click elsewhere", "Send what was typed"},
    {"Escape", "Keep the value that was there before"},
    {"Tab", "Send it and go to the next number"},
    {"Drag the dots beside a number", "Change it; with Shift ten times as fast, with Ctrl a tenth"},
    {"Ctrl+Z", "Take the last change back"},
    {"Ctrl+Y, Ctrl+Shift+Z", "Do it again"},
    {"Scene", ""},
    {"Drag, right drag, wheel", "Turn, move, zoom"},
    {"Double click", "Show the whole box"},
    {"Drag a circle of the box", "Move that wall"},
    {"Drag the sphere", "Move the simulated hand; the wheel changes its depth"},
    {"1, 2", "Press the buttons of the simulated stylus"},
    {"Window", ""},
    {"F1, ?", "This page"},
    {"F2, F3, ...", "Show the pane under the first tab, the second, ..."},
    {"Ctrl+Tab", "Give the keyboard to the next part of the window"},
    {"Arrows, Enter", "Go from one thing to the next in it, and press it"},
};

constexpr const char* title = "Keys and mouse";

}  // namespace

void KeyHelp::draw(const Style& style) {
  if (std::exchange(is_to_be_opened_, false) && !is_dialog_open()) ImGui::OpenPopup(title);
  const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(20), style.points(16)});
  if (ImGui::BeginPopupModal(title, nullptr,
                             ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                 ImGuiWindowFlags_NoSavedSettings)) {
    const Palette& palette = *style.palette;
    text(style.fonts.strong, palette.accent, title);
    for (const Row& row : rows) {
      if (row.what_happens.empty()) {
        ImGui::SetCursorPosY(ImGui::GetCursorPosY() + style.points(4));
        text(style.fonts.strong, palette.text, row.what_one_does);
        continue;
      }
      const float left = ImGui::GetCursorPosX();
      text(palette.text, row.what_one_does);
      ImGui::SameLine();
      ImGui::SetCursorPosX(left + style.points(230));
      text(palette.text_quiet, row.what_happens);
    }
    ImGui::Dummy({0, style.points(8)});
    if (button("Close", {style.points(110), 0}) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
      ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar();
}

}  // namespace inkwell::window
