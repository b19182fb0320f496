#include "status_bar.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace inkwell::window {

using device::Connection;
using protocol::State;

namespace {

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
void gauge(const char* caption, const std::string& value, Colour colour, const char* help, float width,
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
  draw_device(style, desk);
  ImGui::SameLine(0, style.points(14));

  const bool alive = view.connected() && view.pose.has_value();
  const auto& state = protocol::info(view.state());
  gauge("State", alive ? std::string(state.name) : "—", alive ? colour_of(view.state(), palette) : palette.text_quiet,
        alive ? state.meaning.data() : "No device is connected.", style.points(96), style);
  const auto& status = view.status;
  const double load = alive ? view.pose->servo_load / 2.55 : 0.0;
  gauge("Servo load", alive ? fmt::format("{:.0f} %", load) : "—", load > 80 ? palette.caution : palette.text,
        "The longest control interrupt of the last millisecond, as a part of its period.", style.points(74), style);
  gauge("Supply", alive ? fmt::format("{:.1f} V", view.pose->supply_dV / 10.0) : "—", palette.text,
        "Voltage of the bridges' supply, 18 V nominal.", style.points(64), style);
  gauge("Poses", alive ? fmt::format("{:.0f} Hz", status.pose_rate_Hz) : "—", palette.text,
        "Pose reports received in the last second; the device sends 1000.", style.points(72), style);
  const std::uint64_t lost = status.poses_lost + status.scope_samples_lost;
  gauge("Lost", alive ? fmt::format("{}", lost) : "—", lost > 0 ? palette.caution : palette.text,
        fmt::format("Pose reports lost: {}. Scope samples lost: {} of {}.", status.poses_lost,
                    status.scope_samples_lost, status.scope_samples_received + status.scope_samples_lost)
            .c_str(),
        style.points(56), style);

  const float height = style.points(38);
  const float stop_width = style.points(118);
  const float force_width = style.points(116);
  const float gap = style.points(8);
  const auto switches = alive ? view.pose->switches : std::uint8_t{0};
  const auto is_pressed = [switches](protocol::Switch which) {
    return (switches & static_cast<std::uint8_t>(which)) != 0;
  };
  float x = place.x + size.x - style.points(12) - stop_width;
  const float y = place.y + style.points(8);
  ImGui::SetCursorScreenPos({x, y});
  ImGui::PushFont(style.fonts.strong);
  if (coloured_button("STOP", palette.danger, palette.on_danger, {stop_width, height})) outcome.stop = true;
  ImGui::PopFont();
  help_on_hover("Stop", "Switches the force off at once. The space bar does the same, whatever has the focus.", style);

  x -= force_width + gap;
  ImGui::SetCursorScreenPos({x, y});
  const bool active = alive && view.state() == State::active;
  ImGui::BeginDisabled(!alive || (view.state() != State::ready && !active));
  if (active ? coloured_button("Force is on", palette.good, palette.on_danger, {force_width, height})
             : ImGui::Button("Switch force on", {force_width, height})) {
    outcome.switch_force_on = !active;
    outcome.stop = active;
  }
  ImGui::EndDisabled();
  help_on_hover("Force", "While it is on the walls push back. It rises gently and goes off at once.", style);

  const float small = style.points(60);
  x -= small + gap;
  ImGui::SetCursorScreenPos({x, y});
  if (toggle_button("Scope", scope_is_shown, style, {small, height})) outcome.toggle_scope = true;
  x -= small + gap;
  ImGui::SetCursorScreenPos({x, y});
  if (ImGui::Button(style.palette == &dark_palette ? "Light" : "Dark", {small, height})) outcome.toggle_theme = true;

  // The stylus' two buttons and the inkwell, as the board feels them.
  if (alive) {
    const char* names[] = {"1", "2", "inkwell"};
    const protocol::Switch which[] = {protocol::Switch::button_1, protocol::Switch::button_2,
                                      protocol::Switch::inkwell};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    float right = x - style.points(14);
    for (int i = 2; i >= 0; --i) {
      const ImVec2 taken = style.fonts.caption->CalcTextSizeA(style.fonts.caption->FontSize, 1e4f, 0, names[i]);
      right -= taken.x;
      const bool on = is_pressed(which[i]);
      list.AddText(style.fonts.caption, style.fonts.caption->FontSize, {right, y + style.points(11)},
                   packed(on ? palette.text : palette.text_quiet), names[i]);
      list.AddCircleFilled({right - style.points(8), y + style.points(18)}, style.points(3.2f),
                           packed(on ? palette.accent : palette.raised_active));
      right -= style.points(24);
    }
  }
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
