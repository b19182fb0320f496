#include "status_bar.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

namespace inkwell::window {

using device::Connection;
using protocol::State;

namespace {

constexpr float buttons_points = 398.0f;  // what the buttons at the right end take

const char* title_of(Connection connection) {
  switch (connection) {
    case Connection::searching: return "Looking for a device";
    case Connection::connected: return "Connected";
    case Connection::incompatible: return "Another protocol version";
    case Connection::no_permission: return "No permission";
  }
  return "";
}

Colour colour_of(Connection connection, const Palette& palette) {
  if (connection == Connection::connected) return palette.good;
  return connection == Connection::searching ? palette.text_quiet : palette.caution;
}

Colour colour_of(State state, const Palette& palette) {
  switch (state) {
    case State::active: return palette.good;
    case State::fault: return palette.danger;
    case State::ready: return palette.accent;
    default: return palette.caution;
  }
}

// A number with its caption above, in a column of fixed width.
void gauge(const char* caption, const std::string& value, Colour colour, const std::string& help, float width,
           const Style& style) {
  ImGui::BeginGroup();
  text(style.fonts.caption, style.palette->text_quiet, caption);
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() - style.points(6));
  text(style.fonts.body, colour, value);
  ImGui::SameLine(0, 0);
  ImGui::Dummy({std::max(0.0f, width - ImGui::CalcTextSize(value.c_str()).x), 1});
  ImGui::EndGroup();
  help_on_hover(caption, help, style);
  ImGui::SameLine(0, style.points(8));
}

}  // namespace

void StatusBar::draw_device_list(const Style& style, DeviceDesk& desk) {
  const bool open = ImGui::BeginPopup("devices");
  desk.keep_looking(open);
  if (!open) return;
  const Palette& palette = *style.palette;
  const DeviceView& view = desk.view();
  text(style.fonts.strong, palette.text, "Devices");
  if (!view.list_error.empty()) wrapped_text(palette.caution, view.list_error);
  if (view.listed.empty()) text(palette.text_quiet, "None found.");
  for (const device::Endpoint& endpoint : view.listed) {
    const bool present =
        view.connected() && view.status.information && view.status.information->serial_number == endpoint.serial_number;
    const std::string place = endpoint.kind == device::Endpoint::Kind::usb
                                  ? std::string("USB")
                                  : fmt::format("virtual, port {}", endpoint.port);
    if (ImGui::Selectable(fmt::format("{}   {}   {}", endpoint.product, endpoint.serial_number, place).c_str(),
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

void StatusBar::draw_device(const Style& style, DeviceDesk& desk) {
  const DeviceView& view = desk.view();
  const Palette& palette = *style.palette;
  const Connection connection = view.status.connection;
  const std::string serial = view.status.information ? view.status.information->serial_number : std::string{};
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 area{style.points(236), style.points(38)};
  ImGui::PushStyleColor(ImGuiCol_Button, packed(palette.panel));
  if (ImGui::Button("##device", area)) ImGui::OpenPopup("devices");
  ImGui::PopStyleColor();
  if (!view.status.message.empty()) help_on_hover(title_of(connection), view.status.message, style);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled({corner.x + style.points(14), corner.y + 0.5f * area.y}, style.points(4.5f),
                       packed(colour_of(connection, palette)));
  const float left = corner.x + style.points(29);
  list.AddText(style.fonts.strong, style.fonts.strong->FontSize, {left, corner.y + style.points(2)},
               packed(palette.text), title_of(connection));
  list.AddText(style.fonts.caption, style.fonts.caption->FontSize, {left, corner.y + style.points(20)},
               packed(palette.text_quiet), serial.empty() ? "choose a device" : serial.c_str());
  draw_device_list(style, desk);
}

void StatusBar::draw_gauges(float limit_x, const Style& style, const DeviceView& view) const {
  const Palette& palette = *style.palette;
  const bool alive = view.connected() && view.pose.has_value();
  const auto show = [&](const char* caption, const std::string& value, Colour colour, const std::string& help,
                        float width_points) {
    const float width = style.points(width_points);
    if (ImGui::GetCursorScreenPos().x + width < limit_x)
      gauge(caption, alive ? value : "—", alive ? colour : palette.text_quiet, help, width, style);
  };
  const protocol::PoseReport pose = view.pose.value_or(protocol::PoseReport{});
  const protocol::StateInfo& state = protocol::info(pose.state);
  show("State", std::string(state.name), colour_of(pose.state, palette),
       alive ? std::string(state.meaning) : "No device is connected.", 96);
  const double load_percent = 100.0 * pose.servo_load / 255.0;
  show("Servo load", fmt::format("{:.0f} %", load_percent), load_percent > 80 ? palette.caution : palette.text,
       "The longest control interrupt of the last millisecond, as a part of its period.", 74);
  show("Supply", fmt::format("{:.1f} V", pose.supply_dV / 10.0), palette.text,
       "Voltage of the bridges' supply, 18 V nominal.", 64);
  const device::SessionStatus& status = view.status;
  show("Poses", fmt::format("{:.0f} Hz", status.pose_rate_Hz), palette.text,
       "Pose reports received in the last second; the device sends 1000.", 72);
  const std::uint64_t lost = status.poses_lost + status.scope_samples_lost;
  show("Lost", fmt::format("{}", lost), lost > 0 ? palette.caution : palette.text,
       fmt::format("Pose reports lost: {}. Scope samples lost: {} of {}.", status.poses_lost, status.scope_samples_lost,
                   status.scope_samples_received + status.scope_samples_lost),
       56);
}

void StatusBar::draw_switches(float left_x, float right_x, float y, const Style& style, std::uint8_t switches) const {
  static constexpr std::array<std::pair<const char*, protocol::Switch>, 3> all{
      {{"1", protocol::Switch::button_1}, {"2", protocol::Switch::button_2}, {"inkwell", protocol::Switch::inkwell}}};
  if (right_x - left_x < style.points(132)) return;
  const Palette& palette = *style.palette;
  ImFont* font = style.fonts.caption;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float right = right_x - style.points(14);
  for (auto each = all.rbegin(); each != all.rend(); ++each) {
    right -= font->CalcTextSizeA(font->FontSize, 1e4f, 0, each->first).x;
    const bool on = (switches & static_cast<std::uint8_t>(each->second)) != 0;
    list.AddText(font, font->FontSize, {right, y + style.points(11)}, packed(on ? palette.text : palette.text_quiet),
                 each->first);
    list.AddCircleFilled({right - style.points(8), y + style.points(18)}, style.points(3.2f),
                         packed(on ? palette.accent : palette.raised_active));
    right -= style.points(24);
  }
}

StatusBarOutcome StatusBar::draw(ImVec2 place, ImVec2 size, const Style& style, DeviceDesk& desk, bool scope_is_shown) {
  const Palette& palette = *style.palette;
  const DeviceView& view = desk.view();
  StatusBarOutcome outcome;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(12), style.points(8)});
  begin_pane("status", place, size, ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImDrawList& ground = *ImGui::GetWindowDrawList();
  ground.PushClipRectFullScreen();
  ground.AddLine({place.x, place.y + size.y - 1}, {place.x + size.x, place.y + size.y - 1}, packed(palette.line));
  ground.PopClipRect();

  const float height = style.points(38);
  const float gap = style.points(8);
  const float y = place.y + style.points(8);
  const float buttons_left = place.x + size.x - style.points(buttons_points);
  const bool alive = view.connected() && view.pose.has_value();
  draw_device(style, desk);
  ImGui::SameLine(0, style.points(14));
  draw_gauges(buttons_left, style, view);
  if (alive) draw_switches(ImGui::GetCursorScreenPos().x, buttons_left, y, style, view.pose->switches);

  float x = place.x + size.x - style.points(12);
  const auto make_room = [&](float width) {
    x -= width;
    ImGui::SetCursorScreenPos({x, y});
    x -= gap;
    return ImVec2{width, height};
  };
  ImGui::PushFont(style.fonts.strong);
  outcome.stop = coloured_button("STOP", palette.danger, palette.on_danger, make_room(style.points(118)));
  ImGui::PopFont();
  help_on_hover("Stop", "Switches the force off at once. The space bar does the same, whatever has the focus.", style);

  const bool active = alive && view.state() == State::active;
  const ImVec2 force_size = make_room(style.points(116));
  ImGui::BeginDisabled(!alive || (view.state() != State::ready && !active));
  if (active ? coloured_button("Force is on", palette.good, palette.on_danger, force_size)
             : ImGui::Button("Switch force on", force_size)) {
    outcome.switch_force_on = !active;
    outcome.stop = active;
  }
  ImGui::EndDisabled();
  help_on_hover("Force", "While it is on the walls push back. It rises gently and goes off at once.", style);
  outcome.toggle_scope = toggle_button("Scope", scope_is_shown, style, make_room(style.points(60)));
  outcome.toggle_theme = ImGui::Button(style.palette == &dark_palette ? "Light" : "Dark", make_room(style.points(60)));
  end_pane();
  return outcome;
}

bool draw_fault_banner(ImVec2 place, ImVec2 size, const Style& style, protocol::Fault fault) {
  const Palette& palette = *style.palette;
  const protocol::CodeInfo& info = protocol::info(fault);
  begin_pane("fault", place, size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRectFullScreen();
  list.AddRectFilled(place, {place.x + size.x, place.y + size.y}, packed(palette.raised));
  list.AddRectFilled(place, {place.x + style.points(5), place.y + size.y}, packed(palette.danger));
  list.PopClipRect();
  ImGui::SetCursorPos({style.points(18), style.points(9)});
  ImGui::BeginGroup();
  text(style.fonts.strong, palette.text, info.cause);
  text(palette.text_quiet, info.remedy);
  ImGui::EndGroup();
  ImGui::SetCursorPos({size.x - style.points(130), style.points(14)});
  const bool pressed =
      coloured_button("Clear fault", palette.danger, palette.on_danger, {style.points(118), style.points(34)});
  end_pane();
  return pressed;
}

void draw_connection_card(ImVec2 centre, const Style& style, const DeviceView& view) {
  const Palette& palette = *style.palette;
  ImGui::SetNextWindowPos(centre, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({style.points(420), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, style.points(8));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(20), style.points(16)});
  ImGui::Begin("connection", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  text(style.fonts.strong, colour_of(view.status.connection, palette), title_of(view.status.connection));
  const std::string& message = view.status.message.empty() ? view.list_error : view.status.message;
  wrapped_text(palette.text_quiet, message.empty() ? "Plug in the arm's USB cable. It is found by itself." : message);
  ImGui::End();
  ImGui::PopStyleVar(2);
}

}  // namespace inkwell::window
