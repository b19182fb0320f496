#include "host/companion/window/bars/status_bar.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host/companion/window/bars/connection_card.hpp"
#include "host/companion/window/frame/flow_layout.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"

#include "host/companion/window/bars/gauges.hpp"

namespace inkwell::window {

using device::Connection;
using protocol::State;

namespace {

constexpr float margin_points = 12.0f;
constexpr float item_points = 38.0f;  // height of the buttons and of a gauge row
constexpr float row_points = 46.0f;
constexpr float gap_points = 8.0f;
constexpr float stop_points = 100.0f;
constexpr float force_points = 114.0f;
constexpr float scope_points = 60.0f;
constexpr float theme_points = 28.0f;
constexpr float record_points = 116.0f;
constexpr float mark_points = 48.0f;
constexpr float help_points = 28.0f;
constexpr float buttons_points = stop_points + force_points + record_points + scope_points + theme_points +
                                 help_points + 6 * gap_points + margin_points;

/// Items of the bar, from left to right.
enum Item : std::size_t {
  device_item,
  state_item,
  load_item,
  supply_item,
  heat_item,
  poses_item,
  lost_item,
  switches_item
};
constexpr std::array<float, 8> item_widths_points{176, 92, 72, 54, 78, 62, 44, 122};

std::vector<FlowPosition> positions_of(float width, const Style& style) {
  std::vector<float> widths;
  for (float points : item_widths_points) widths.push_back(style.points(points));
  const float row = width - style.points(2 * margin_points);
  return flow(widths, row - style.points(buttons_points - margin_points), row, style.points(gap_points));
}

// Draws the STOP button. The button reacts when the mouse button is pressed. The button works while a dialog is open.
bool stop_button(ImVec2 size, const Style& style) {
  const Palette& palette = *style.palette;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 end{corner.x + size.x, corner.y + size.y};
  coloured_button("STOP", palette.danger, palette.on_danger, size);
  if (is_dialog_open()) {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const ImVec2 taken = ImGui::CalcTextSize("STOP");
    list.AddRectFilled(corner, end, packed(palette.danger), ImGui::GetStyle().FrameRounding);
    list.AddText({corner.x + 0.5f * (size.x - taken.x), corner.y + 0.5f * (size.y - taken.y)},
                 packed(palette.on_danger), "STOP");
  }
  return ImGui::IsMouseClicked(ImGuiMouseButton_Left) && ImGui::IsMouseHoveringRect(corner, end, false);
}

// Draws a half-filled circle.
bool theme_button(ImVec2 size, const Style& style) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const bool is_dark = style.palette == &dark_palette;
  const bool pressed = button("##theme", size);
  const ImVec2 centre{corner.x + 0.5f * size.x, corner.y + 0.5f * size.y};
  const float radius = style.points(6.5f), quarter = 0.5f * std::numbers::pi_v<float>;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircle(centre, radius, packed(style.palette->text), 0, style.points(1.5f));
  list.PathArcTo(centre, radius, -quarter, quarter, 12);
  list.PathFillConvex(packed(style.palette->text));
  help_on_hover(is_dark ? "Light theme" : "Dark theme", "Changes the colors of the window.", style);
  return pressed;
}

}  // namespace

void StatusBar::draw_recording(ImVec2 corner, const Style& style, const StatusBarInput& input,
                               StatusBarOutcome& outcome) const {
  const Palette& palette = *style.palette;
  const float height = style.points(item_points), width = style.points(record_points), gap = style.points(4);
  const auto dot = [&](float x, bool is_square) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = corner.y + 0.5f * height, half = style.points(4.5f);
    if (is_square)
      list.AddRectFilled({x - half, y - half}, {x + half, y + half}, packed(palette.danger_text));
    else
      list.AddCircleFilled({x, y}, half, packed(palette.danger_text));
  };
  ImGui::SetCursorScreenPos(corner);
  if (input.recording_clock.empty()) {
    ImGui::BeginDisabled(!input.recording_waits.empty());
    outcome.toggle_recording = button("    Record", {width, height});
    note_item("Record");
    ImGui::EndDisabled();
    dot(corner.x + style.points(26), false);
    help_on_hover("Record",
                  input.recording_waits.empty()
                      ? "Starts a recording with the choices of the pane Recording. Key: Ctrl+R"
                      : input.recording_waits,
                  style);
    return;
  }
  outcome.mark = button("Mark", {style.points(mark_points), height});
  help_on_hover("Mark", "Adds a mark to the recording. Key: Ctrl+M", style);
  const float left = corner.x + style.points(mark_points) + gap;
  ImGui::SetCursorScreenPos({left, corner.y});
  outcome.toggle_recording = button(("    " + input.recording_clock + "###Stop recording").c_str(),
                                    {width - style.points(mark_points) - gap, height});
  note_item("Stop recording");
  dot(left + style.points(14), true);
  help_on_hover("Stop recording", "Stops the recording and completes its file. Key: Ctrl+R", style);
}

void StatusBar::draw_device_list(const Style& style, DeviceDesk& desk) {
  const bool open = ImGui::BeginPopup("devices");
  desk.keep_searching(open);
  if (!open) return;
  const Palette& palette = *style.palette;
  const DeviceView& view = desk.view();
  text(style.fonts.strong, palette.text, "Devices");
  if (!view.list_error.empty()) wrapped_text(palette.caution, view.list_error);
  if (view.listed.empty()) text(palette.text_quiet, "No device found.");
  for (const device::Endpoint& endpoint : view.listed) {
    const bool present =
        view.connected() && view.status.information && view.status.information->serial_number == endpoint.serial_number;
    const std::string location = endpoint.kind == device::Endpoint::Kind::usb
                                     ? std::string("USB")
                                     : fmt::format("virtual, {}", endpoint.server.text());
    if (ImGui::Selectable(fmt::format("{}   {}   {}", endpoint.product, endpoint.serial_number, location).c_str(),
                          present))
      if (!present) desk.choose(endpoint.serial_number);
  }
  if (!desk.wanted_serial_number().empty() && ImGui::Selectable("Any device")) desk.choose("");
  if (view.status.information) {
    const auto& information = *view.status.information;
    ImGui::Separator();
    text(palette.text_quiet,
         fmt::format("Firmware {}, protocol version {}", information.firmware_version, information.protocol_version));
    text(palette.text_quiet,
         fmt::format("Longest control interrupt: {} of {} cycles", information.report.servo_cycles_longest,
                     information.report.processor_clock_Hz / std::max(information.report.servo_rate_Hz, 1u)));
  }
  ImGui::EndPopup();
}

void StatusBar::draw_device(ImVec2 corner, const Style& style, DeviceDesk& desk) {
  const DeviceView& view = desk.view();
  const Palette& palette = *style.palette;
  const Connection connection = view.status.connection;
  const std::string serial = view.status.information ? view.status.information->serial_number : std::string{};
  const ImVec2 area{style.points(item_widths_points[device_item] - 6), style.points(item_points)};
  ImGui::SetCursorScreenPos(corner);
  ImGui::PushStyleColor(ImGuiCol_Button, packed(palette.pane));
  if (button("##device", area)) ImGui::OpenPopup("devices");
  ImGui::PopStyleColor();
  if (!view.status.message.empty()) help_on_hover(connection_title(view.status), view.status.message, style);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled({corner.x + style.points(14), corner.y + 0.5f * area.y}, style.points(4.5f),
                       packed(connection_colour(connection, palette)));
  const float left = corner.x + style.points(29), room = corner.x + area.x - left;
  list.AddText(style.fonts.strong, style.fonts.strong->FontSize, {left, corner.y + style.points(2)},
               packed(palette.text), fitted(connection_title(view.status), room, style.fonts.strong).c_str());
  list.AddText(style.fonts.caption, style.fonts.caption->FontSize, {left, corner.y + style.points(20)},
               packed(palette.text_quiet),
               fitted(serial.empty() ? "choose a device" : serial, room, style.fonts.caption).c_str());
  draw_device_list(style, desk);
}

void StatusBar::draw_switches(ImVec2 corner, const Style& style, std::uint8_t switches) const {
  static constexpr std::array<std::pair<const char*, protocol::Switch>, 3> all{
      {{"1", protocol::Switch::button_1}, {"2", protocol::Switch::button_2}, {"inkwell", protocol::Switch::inkwell}}};
  const Palette& palette = *style.palette;
  ImFont* font = style.fonts.caption;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float x = corner.x;
  for (const auto& [name, which] : all) {
    const bool on = is_closed(switches, which);
    list.AddCircleFilled({x + style.points(4), corner.y + style.points(19)}, style.points(3.2f),
                         packed(on ? palette.accent : palette.raised_active));
    list.AddText(font, font->FontSize, {x + style.points(12), corner.y + style.points(12)},
                 packed(on ? palette.text : palette.text_quiet), name);
    x += font->CalcTextSizeA(font->FontSize, 1e4f, 0, name).x + style.points(24);
  }
  ImGui::SetCursorScreenPos(corner);
  ImGui::InvisibleButton("switches", {x - corner.x, style.points(item_points)});
  help_on_hover("Switches", "State of the two stylus buttons and of the inkwell switch.", style);
}

float StatusBar::height(float width, const Style& style) const {
  const int rows = positions_of(width, style).back().row + 1;
  return style.points(gap_points + row_points * static_cast<float>(rows));
}

/// Draws the buttons to the left of `corner`.
void StatusBar::draw_buttons(ImVec2 corner, const Style& style, const DeviceView& view, const StatusBarInput& input,
                             StatusBarOutcome& outcome) const {
  const Palette& palette = *style.palette;
  float x = corner.x;
  const auto make_room = [&](float points) {
    x -= style.points(points);
    ImGui::SetCursorScreenPos({x, corner.y});
    x -= style.points(gap_points);
    return ImVec2{style.points(points), style.points(item_points)};
  };
  ImGui::PushFont(style.fonts.strong);
  outcome.stop = stop_button(make_room(stop_points), style);
  ImGui::PopFont();
  help_on_hover("Stop", "Switches the force off immediately, like the keys Escape and F12.", style);

  const bool alive = view.pose.has_value();
  const bool active = alive && protocol::force_is_on(view.state());
  const bool can_switch_on = alive && view.state() == State::ready && input.force_waits.empty();
  const ImVec2 force_size = make_room(force_points);
  ImGui::BeginDisabled(!active && !can_switch_on);
  if (active          ? coloured_button("Force is on###force", palette.good, palette.on_good, force_size)
      : can_switch_on ? primary_button("Switch force on###force", style, force_size)
                      : button("Switch force on###force", force_size)) {
    outcome.switch_force_on = !active;
    outcome.stop |= active;
  }
  ImGui::EndDisabled();
  help_on_hover("Force",
                !active && !input.force_waits.empty()
                    ? input.force_waits
                    : "While the force is on, walls and programs push the hand. The force rises slowly "
                      "after switch-on and drops immediately after switch-off.",
                style);
  make_room(record_points);
  draw_recording(ImGui::GetCursorScreenPos(), style, input, outcome);
  outcome.toggle_scope = toggle_button("Scope", input.scope_is_shown, style, make_room(scope_points));
  outcome.toggle_theme = theme_button(make_room(theme_points), style);
  outcome.help = button("?", make_room(help_points));
  help_on_hover("Keys and mouse", "Lists all keys and mouse actions. F1 also opens this list.", style);
}

StatusBarOutcome StatusBar::draw(ImVec2 origin, ImVec2 size, const Style& style, DeviceDesk& desk,
                                 const StatusBarInput& input) {
  const Palette& palette = *style.palette;
  const DeviceView& view = desk.view();
  StatusBarOutcome outcome;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(12), style.points(8)});
  begin_pane("status", origin, size, ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImDrawList& ground = *ImGui::GetWindowDrawList();
  ground.PushClipRectFullScreen();
  ground.AddLine({origin.x, origin.y + size.y - 1}, {origin.x + size.x, origin.y + size.y - 1}, packed(palette.line));
  ground.PopClipRect();

  const float height = style.points(item_points);
  const float y = origin.y + style.points(gap_points);
  const bool alive = view.pose.has_value();
  const std::vector<FlowPosition> positions = positions_of(size.x, style);
  const auto corner = [&](Item item) {
    return ImVec2{origin.x + style.points(margin_points) + positions[item].x,
                  y + style.points(row_points) * static_cast<float>(positions[item].row)};
  };
  draw_device(corner(device_item), style, desk);
  const std::vector<Gauge> gauges = gauges_of(view, palette);
  for (std::size_t i = 0; i < gauges.size(); ++i) {
    const auto item = static_cast<Item>(state_item + i);
    draw_gauge(gauges[i], corner(item), {style.points(item_widths_points[item]), height}, style);
  }
  if (alive) draw_switches(corner(switches_item), style, view.pose->switches);

  draw_buttons({origin.x + size.x - style.points(margin_points), y}, style, view, input, outcome);
  end_pane();
  return outcome;
}

}  // namespace inkwell::window
