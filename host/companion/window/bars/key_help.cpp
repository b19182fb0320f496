#include "host/companion/window/bars/key_help.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

namespace {

struct Row {
  std::string_view what_one_does;
  std::string_view what_happens;  ///< empty: the row is a heading
};

constexpr auto left_rows = std::to_array<Row>({
    {"Force", ""},
    {"Escape, F12", "Switch the force off at any time"},
    {"Space", "Switch the force off outside text fields"},
    {"Values", ""},
    {"Click a number, or Enter", "Type a new number"},
    {"Enter, or a click elsewhere", "Send the typed number"},
    {"Escape", "Restore the old number"},
    {"Tab", "Send the number, edit the next one"},
    {"Drag the dots next to a number", "Change the number (Shift: faster, Ctrl: slower)"},
    {"Ctrl+Z", "Undo the last change"},
    {"Ctrl+Y, Ctrl+Shift+Z", "Redo the last undone change"},
    {"Recording", ""},
    {"Ctrl+R", "Start or stop a recording"},
    {"Ctrl+M", "Add a mark"},
    {"Ctrl+S", "Save the last 60 s"},
    {"Keyboard", ""},
    {"Ctrl+Tab, Ctrl+Shift+Tab", "Move to the next or previous part"},
    {"Arrows, Enter", "Select a control, activate a control"},
    {"F2, F3, ...", "Show the first pane, second pane, ..."},
    {"Page Up, Page Down", "Scroll"},
    {"Alt+arrows", "Resize the parts of the window"},
    {"F1, ?", "Show this page"},
});

constexpr auto right_rows = std::to_array<Row>({
    {"Scene", ""},
    {"Drag, right drag, wheel", "Turn, move, zoom"},
    {"Shift+arrows", "Turn (with Ctrl+Shift: move)"},
    {"Shift+Page Up, Page Down", "Zoom"},
    {"Double click", "Show the whole box"},
    {"Drag a circle of the box", "Move a wall (keyboard: type its position in Tuning)"},
    {"Drag the sphere", "Move the simulated hand; the wheel changes its depth"},
    {"Ctrl+arrows, Page Up, Page Down", "Move the simulated hand"},
    {"1, 2", "Press the buttons of the simulated stylus"},
    {"Plots", ""},
    {"Ctrl+P", "Pause or resume the plots or the replay"},
    {"Drag, wheel, double click", "Move in time, zoom, resume"},
    {"Shift+arrows", "Move in time, zoom, seek in a replay"},
    {"Drag a cursor, or Ctrl+arrows", "Move the first cursor (with Ctrl+Shift: the second cursor)"},
    {"Click a title, or Enter", "Choose signals and plot type"},
});

constexpr float keys_points = 172.0f;
constexpr float column_points = 400.0f;
constexpr float gap_points = 24.0f;

// Draws the rows at the cursor position and moves the cursor below the rows.
void draw_rows(std::span<const Row> rows, const Style& style) {
  const Palette& palette = *style.palette;
  const float left = ImGui::GetCursorPosX();
  const auto cell = [&](Colour colour, std::string_view content, float from_points, float to_points) {
    ImGui::SetCursorPosX(left + style.points(from_points));
    ImGui::PushTextWrapPos(left + style.points(to_points));
    text(colour, content);
    ImGui::PopTextWrapPos();
    return ImGui::GetCursorPosY();
  };
  ImGui::BeginGroup();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ImGui::GetStyle().ItemSpacing.x, style.points(2)});
  for (const Row& row : rows) {
    if (row.what_happens.empty()) {
      ImGui::SetCursorPosY(ImGui::GetCursorPosY() + style.points(4));
      text(style.fonts.strong, palette.text, row.what_one_does);
      continue;
    }
    const float top = ImGui::GetCursorPosY();
    const float end = cell(palette.text, row.what_one_does, 0, keys_points - 8);
    ImGui::SetCursorPosY(top);
    ImGui::SetCursorPosY(std::max(end, cell(palette.text_quiet, row.what_happens, keys_points, column_points)));
  }
  ImGui::PopStyleVar();
  ImGui::EndGroup();
}

constexpr const char* title = "Keys and mouse";

}  // namespace

void KeyHelp::draw(const Style& style) {
  if (std::exchange(is_to_be_opened_, false) && !is_dialog_open()) ImGui::OpenPopup(title);
  const ImGuiViewport& viewport = *ImGui::GetMainViewport();
  const ImVec2 middle = viewport.GetCenter();
  ImGui::SetNextWindowSizeConstraints({0, 0}, viewport.Size);  // a page that is too tall scrolls
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(20), style.points(16)});
  if (ImGui::BeginPopupModal(title, nullptr,
                             ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                 ImGuiWindowFlags_NoSavedSettings)) {
    const Palette& palette = *style.palette;
    text(style.fonts.strong, palette.accent, title);
    const float left = ImGui::GetCursorPosX();
    const float top = ImGui::GetCursorPosY();
    draw_rows(left_rows, style);
    const float end = ImGui::GetCursorPosY();
    ImGui::SetCursorPos({left + style.points(column_points + gap_points), top});
    draw_rows(right_rows, style);
    ImGui::SetCursorPos({left, std::max(end, ImGui::GetCursorPosY())});
    ImGui::Dummy({0, style.points(8)});
    if (button("Close", {style.points(110), 0}) || ImGui::IsKeyPressed(key_index(ImGuiKey_Escape)))
      ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar();
}

}  // namespace inkwell::window
