#include "host/companion/window/bars/gauges.hpp"

#include <fmt/format.h>

#include "host/companion/window/device_desk/motor_heat_view.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

using protocol::State;

namespace {

Colour colour_of(const device::Pose& pose, const Palette& palette) {
  switch (pose.state) {
    case State::ramping:
    case State::active: return palette.good;
    case State::fault: return palette.danger_text;
    case State::ready: return palette.accent;
    default: return palette.caution;
  }
}

/// Returns "program" while a program or shapes exert a force, and otherwise the name of the state.
std::string state_text(const device::Pose& pose) {
  const bool program = protocol::is_felt(pose.force_sources, protocol::ForceSource::program) ||
                       protocol::is_felt(pose.force_sources, protocol::ForceSource::shapes);
  return protocol::force_is_on(pose.state) && program ? "program" : std::string(protocol::info(pose.state).name);
}

std::string state_help(const device::Pose& pose) {
  std::string help(protocol::info(pose.state).meaning);
  if (!protocol::force_is_on(pose.state)) return help;
  for (const auto& row : protocol::force_source_table)
    if (protocol::is_felt(pose.force_sources, row.source)) help += fmt::format("\n{}", row.meaning);
  for (const auto& row : protocol::limit_table)
    if (protocol::is_reached(pose.limits, row.limit)) help += fmt::format("\n{}", row.meaning);
  return help;
}

Colour colour_of(HeatLevel level, const Palette& palette) {
  return level == HeatLevel::hot ? palette.danger_text : level == HeatLevel::warm ? palette.caution : palette.text;
}

}  // namespace

std::vector<Gauge> gauges_of(const DeviceView& view, const Palette& palette) {
  const bool alive = view.pose.has_value() && view.status.information.has_value();
  const device::Pose pose = view.pose.value_or(device::Pose{});
  const device::SessionStatus& status = view.status;
  const MotorHeatView heat = alive ? motor_heat_view(status.information->report) : MotorHeatView{};
  const double load_percent = 100.0 * pose.servo_load / 255.0;
  const std::uint64_t lost = status.poses_lost + status.scope_samples_lost;
  const std::string advice = heat_advice(heat);
  std::vector<Gauge> gauges{
      {"State", state_text(pose), colour_of(pose, palette), alive ? state_help(pose) : "No device is connected.",
       pose.state == State::fault},
      {"Servo load", fmt::format("{:.0f} %", load_percent), load_percent > 80 ? palette.caution : palette.text,
       "Longest control interrupt since the previous pose report, in percent of the control period.",
       load_percent > 80},
      {"Supply", fmt::format("{:.1f} V", pose.supply_dV / 10.0), palette.text, "Supply voltage of the bridges."},
      {"Motor heat", fmt::format("{:.0f} %", 100.0f * heat.hottest), colour_of(heat.level, palette),
       fmt::format("Heat of motor {}, the hottest motor. The motor reaches 100 % at its continuous current.{}{}",
                   heat.motor, advice.empty() ? "" : "\n", advice),
       heat.level != HeatLevel::cool},
      {"Poses", fmt::format("{:.0f} Hz", status.pose_rate_Hz), palette.text,
       fmt::format("Pose reports received per second. The device sends {} per second.", protocol::pose_rate_Hz)},
      {"Lost", fmt::format("{}", lost), lost > 0 ? palette.caution : palette.text,
       fmt::format("Pose reports lost: {}. Scope samples lost: {} of {}.", status.poses_lost, status.scope_samples_lost,
                   status.scope_samples_received + status.scope_samples_lost)}};
  if (!alive)
    for (Gauge& gauge : gauges) gauge = {gauge.caption, "—", palette.text_quiet, gauge.help};
  return gauges;
}

void draw_gauge(const Gauge& gauge, ImVec2 corner, ImVec2 size, const Style& style) {
  ImGui::SetCursorScreenPos(corner);
  ImGui::InvisibleButton(gauge.caption, size);
  help_on_hover(gauge.caption, gauge.help, style);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddText(style.fonts.caption, style.fonts.caption->FontSize, {corner.x, corner.y + style.points(1)},
               packed(style.palette->text_quiet), gauge.caption);
  float left = corner.x;
  const float top = corner.y + style.points(16);
  if (gauge.warns) left += warning_sign({left, top}, gauge.colour, style);
  list.AddText(style.fonts.body, style.fonts.body->FontSize, {left, top}, packed(gauge.colour), gauge.value.c_str());
}

}  // namespace inkwell::window
