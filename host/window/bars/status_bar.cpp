#include <bars/status_bar.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <device_desk/motor_heat_view.hpp>
#include <frame/flow_layout.hpp>

namespace inkwell::window {

using device::Connection;
using protocol::State;

namespace {

constexpr float margin_points = 12.0f;
constexpr float item_points = 38.0f;  // height of the buttons and of a row of gauges
constexpr float row_points = 46.0f;
constexpr float gap_points = 8.0f;
constexpr float buttons_points = 398.0f;  // what the buttons at the right end take
constexpr float banner_button_points = 118.0f;

/// Device, gauges, switches: from left to right.
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
constexpr std::array<float, 8> item_widths_points{214, 92, 72, 54, 78, 62, 44, 122};

std::vector<FlowPlace> places_of(float width, const Style& style) {
  std::vector<float> widths;
  for (float points : item_widths_points) widths.push_back(style.points(points));
  const float row = width - style.points(2 * margin_points);
  return flow(widths, row - style.points(buttons_points - margin_points), row, style.points(gap_points));
}

const char* title_of(const device::SessionStatus& status) {
  switch (status.connection) {
    case Connection::searching: return "Looking for a device";
    case Connection::connected: return status.is_simulation ? "Connected to a simulation" : "Connected";
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

struct Gauge {
  const char* caption;
  std::string value;
  Colour colour;
  std::string help;
  bool warns = false;  ///< told by a sign as well as by the colour
};

// A number with its caption above.
void draw_gauge(const Gauge& gauge, ImVec2 corner, float width, const Style& style) {
  ImGui::SetCursorScreenPos(corner);
  ImGui::InvisibleButton(gauge.caption, {width, style.points(item_points)});
  help_on_hover(gauge.caption, gauge.help, style);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddText(style.fonts.caption, style.fonts.caption->FontSize, {corner.x, corner.y + style.points(1)},
               packed(style.palette->text_quiet), gauge.caption);
  float left = corner.x;
  const float top = corner.y + style.points(16);
  if (gauge.warns) left += warning_sign({left, top}, gauge.colour, style);
  list.AddText(style.fonts.body, style.fonts.body->FontSize, {left, top}, packed(gauge.colour), gauge.value.c_str());
}

Colour colour_of(HeatLevel level, const Palette& palette) {
  return level == HeatLevel::hot ? palette.danger : level == HeatLevel::warm ? palette.caution : palette.text;
}

// In the order of the items from state_item on.
std::vector<Gauge> gauges_of(const DeviceView& view, const Palette& palette) {
  const bool alive = view.connected() && view.pose.has_value() && view.status.information.has_value();
  const protocol::PoseReport pose = view.pose.value_or(protocol::PoseReport{});
  const device::SessionStatus& status = view.status;
  const MotorHeatView heat = alive ? motor_heat_view(status.information->report) : MotorHeatView{};
  const double load_percent = 100.0 * pose.servo_load / 255.0;
  const std::uint64_t lost = status.poses_lost + status.scope_samples_lost;
  const protocol::StateInfo& state = protocol::info(pose.state);
  const std::string advice = heat_advice(heat);
  std::vector<Gauge> gauges{
      {"State", std::string(state.name), colour_of(pose.state, palette),
       alive ? std::string(state.meaning) : "No device is connected.", pose.state == State::fault},
      {"Servo load", fmt::format("{:.0f} %", load_percent), load_percent > 80 ? palette.caution : palette.text,
       "The longest control interrupt of the last millisecond, as a part of its period.", load_percent > 80},
      {"Supply", fmt::format("{:.1f} V", pose.supply_dV / 10.0), palette.text,
       "Voltage of the bridges' supply, 18 V nominal."},
      {"Motor heat", fmt::format("{:.0f} %", 100.0f * heat.hottest), colour_of(heat.level, palette),
       fmt::format("Of the hottest motor, number {}. 100 % is what its continuous current leads to.{}{}", heat.motor,
                   advice.empty() ? "" : "\n", advice),
       heat.level != HeatLevel::cool},
      {"Poses", fmt::format("{:.0f} Hz", status.pose_rate_Hz), palette.text,
       "Pose reports received in the last second; the device sends 1000."},
      {"Lost", fmt::format("{}", lost), lost > 0 ? palette.caution : palette.text,
       fmt::format("Pose reports lost: {}. Scope samples lost: {} of {}.", status.poses_lost, status.scope_samples_lost,
                   status.scope_samples_received + status.scope_samples_lost)}};
  if (!alive)
    for (Gauge& gauge : gauges) gauge = {gauge.caption, "—", palette.text_quiet, gauge.help};
  return gauges;
}

// Works on the press, not on the release, and also while a dialog or an open list keeps the mouse to itself.
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

void StatusBar::draw_device(ImVec2 corner, const Style& style, DeviceDesk& desk) {
  const DeviceView& view = desk.view();
  const Palette& palette = *style.palette;
  const Connection connection = view.status.connection;
  const std::string serial = view.status.information ? view.status.information->serial_number : std::string{};
  const ImVec2 area{style.points(item_widths_points[device_item]), style.points(item_points)};
  ImGui::SetCursorScreenPos(corner);
  ImGui::PushStyleColor(ImGuiCol_Button, packed(palette.panel));
  if (button("##device", area)) ImGui::OpenPopup("devices");
  ImGui::PopStyleColor();
  if (!view.status.message.empty()) help_on_hover(title_of(view.status), view.status.message, style);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled({corner.x + style.points(14), corner.y + 0.5f * area.y}, style.points(4.5f),
                       packed(colour_of(connection, palette)));
  const float left = corner.x + style.points(29);
  list.AddText(style.fonts.strong, style.fonts.strong->FontSize, {left, corner.y + style.points(2)},
               packed(palette.text), title_of(view.status));
  list.AddText(style.fonts.caption, style.fonts.caption->FontSize, {left, corner.y + style.points(20)},
               packed(palette.text_quiet), serial.empty() ? "choose a device" : serial.c_str());
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
    const bool on = (switches & static_cast<std::uint8_t>(which)) != 0;
    list.AddCircleFilled({x + style.points(4), corner.y + style.points(19)}, style.points(3.2f),
                         packed(on ? palette.accent : palette.raised_active));
    list.AddText(font, font->FontSize, {x + style.points(12), corner.y + style.points(12)},
                 packed(on ? palette.text : palette.text_quiet), name);
    x += font->CalcTextSizeA(font->FontSize, 1e4f, 0, name).x + style.points(24);
  }
  ImGui::SetCursorScreenPos(corner);
  ImGui::InvisibleButton("switches", {x - corner.x, style.points(item_points)});
  help_on_hover("Switches", "The two buttons of the stylus, and the inkwell that feels it.", style);
}

float StatusBar::height(float width, const Style& style) const {
  const int rows = places_of(width, style).back().row + 1;
  return style.points(gap_points + row_points * static_cast<float>(rows));
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

  const float height = style.points(item_points);
  const float gap = style.points(gap_points);
  const float y = place.y + gap;
  const bool alive = view.connected() && view.pose.has_value();
  const std::vector<FlowPlace> places = places_of(size.x, style);
  const auto corner = [&](Item item) {
    return ImVec2{place.x + style.points(margin_points) + places[item].x,
                  y + style.points(row_points) * static_cast<float>(places[item].row)};
  };
  draw_device(corner(device_item), style, desk);
  const std::vector<Gauge> gauges = gauges_of(view, palette);
  for (std::size_t i = 0; i < gauges.size(); ++i) {
    const auto item = static_cast<Item>(state_item + i);
    draw_gauge(gauges[i], corner(item), style.points(item_widths_points[item]), style);
  }
  if (alive) draw_switches(corner(switches_item), style, view.pose->switches);

  float x = place.x + size.x - style.points(12);
  const auto make_room = [&](float width) {
    x -= width;
    ImGui::SetCursorScreenPos({x, y});
    x -= gap;
    return ImVec2{width, height};
  };
  ImGui::PushFont(style.fonts.strong);
  outcome.stop = stop_button(make_room(style.points(118)), style);
  ImGui::PopFont();
  help_on_hover("Stop", "Switches the force off at once. The space bar does the same, whatever has the focus.", style);

  const bool active = alive && view.state() == State::active;
  const ImVec2 force_size = make_room(style.points(116));
  ImGui::BeginDisabled(!alive || (view.state() != State::ready && !active));
  if (active ? coloured_button("Force is on", palette.good, palette.on_danger, force_size)
             : button("Switch force on", force_size)) {
    outcome.switch_force_on = !active;
    outcome.stop = active;
  }
  ImGui::EndDisabled();
  help_on_hover("Force", "While it is on the walls push back. It rises gently and goes off at once.", style);
  outcome.toggle_scope = toggle_button("Scope", scope_is_shown, style, make_room(style.points(60)));
  outcome.toggle_theme = button(style.palette == &dark_palette ? "Light" : "Dark", make_room(style.points(60)));
  end_pane();
  return outcome;
}

std::optional<Banner> banner_of(const DeviceView& view) {
  if (view.pose && view.pose->state == State::fault) {
    const protocol::CodeInfo& info = protocol::info(view.pose->fault);
    return Banner{std::string(info.cause), std::string(info.remedy), true};
  }
  if (!view.connected() || !view.status.information) return std::nullopt;
  const MotorHeatView heat = motor_heat_view(view.status.information->report);
  if (heat.level != HeatLevel::hot) return std::nullopt;
  return Banner{fmt::format("Motor {} is hot: {:.0f} %.", heat.motor, 100.0f * heat.hottest), heat_advice(heat), false};
}

namespace {

float banner_text_width(float width, const Style& style, const Banner& banner) {
  return width - style.points(44 + (banner.is_fault ? banner_button_points + 2 * margin_points : margin_points));
}

}  // namespace

float banner_height(float width, const Style& style, const Banner& banner) {
  const float room = banner_text_width(width, style, banner);
  const auto taken = [room](ImFont* font, const std::string& text) {
    return font->CalcTextSizeA(font->FontSize, 1e4f, room, text.c_str()).y;
  };
  return taken(style.fonts.strong, banner.what) + taken(style.fonts.body, banner.remedy) + style.points(26);
}

bool draw_banner(ImVec2 place, ImVec2 size, const Style& style, const Banner& banner) {
  const Palette& palette = *style.palette;
  const Colour colour = banner.is_fault ? palette.danger : palette.caution;
  begin_pane("banner", place, size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRectFullScreen();
  list.AddRectFilled(place, {place.x + size.x, place.y + size.y}, packed(palette.raised));
  list.AddRectFilled(place, {place.x + style.points(5), place.y + size.y}, packed(colour));
  list.PopClipRect();
  warning_sign({place.x + style.points(18), place.y + style.points(10)}, colour, style);
  ImGui::SetCursorPos({style.points(44), style.points(9)});
  ImGui::BeginGroup();
  ImGui::PushTextWrapPos(style.points(44) + banner_text_width(size.x, style, banner));
  text(style.fonts.strong, palette.text, banner.what);
  text(palette.text_quiet, banner.remedy);
  ImGui::PopTextWrapPos();
  ImGui::EndGroup();
  bool pressed = false;
  if (banner.is_fault) {
    ImGui::SetCursorPos({size.x - style.points(banner_button_points + margin_points), style.points(14)});
    pressed = coloured_button("Clear fault", palette.danger, palette.on_danger,
                              {style.points(banner_button_points), style.points(34)});
  }
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
  text(style.fonts.strong, colour_of(view.status.connection, palette), title_of(view.status));
  const std::string& message = view.status.message.empty() ? view.list_error : view.status.message;
  wrapped_text(palette.text_quiet, message.empty() ? "Plug in the arm's USB cable. It is found by itself." : message);
  ImGui::End();
  ImGui::PopStyleVar(2);
}

}  // namespace inkwell::window
