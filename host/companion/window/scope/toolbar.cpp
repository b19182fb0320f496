#include "host/companion/window/scope/toolbar.hpp"

#include <array>
#include <string>

#include <fmt/format.h>

#include "host/companion/window/frame/shown_unit.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

namespace {

constexpr std::array<double, 10> spans_s{0.002, 0.01, 0.05, 0.2, 0.5, 1.0, 2.0, 5.0, 20.0, 60.0};

std::string span_label(double span_s) {
  return span_s < 1.0 ? fmt::format("{:.3g} ms", 1000.0 * span_s) : fmt::format("{:.3g} s", span_s);
}

void choose_trigger_signal(const char* label, protocol::Signal& signal, float width, const Style& style) {
  if (!begin_combo(label, protocol::info(signal).name, width, ImGuiComboFlags_HeightLarge)) return;
  for (const SignalGroup& group : signal_groups({})) {
    text(ImGui::GetFont(), style.palette->text_quiet, group.title);
    for (const protocol::Signal offered : group.signals)
      if (ImGui::Selectable(protocol::info(offered).name.data(), offered == signal)) signal = offered;
  }
  ImGui::EndCombo();
}

void draw_span(Timeline& timeline, const Style& style) {
  same_line_if_room(style.points(84));
  ImGui::SetNextItemWidth(style.points(84));
  if (ImGui::BeginCombo("##span", span_label(timeline.span_s()).c_str(), ImGuiComboFlags_HeightLarge)) {
    for (double span_s : spans_s)
      if (ImGui::Selectable(span_label(span_s).c_str(), span_s == timeline.span_s())) timeline.set_span_s(span_s);
    ImGui::EndCombo();
  }
  help_on_hover("Time span", "The mouse wheel over a plot also changes the time span.", style);
}

TriggerMode choose_mode(TriggerMode chosen, const Style& style) {
  static constexpr std::array<const char*, 3> modes{"no trigger", "trigger", "single"};
  auto mode = static_cast<int>(chosen);
  same_line_if_room(style.points(100));
  ImGui::SetNextItemWidth(style.points(100));
  ImGui::Combo("##mode", &mode, modes.data(), static_cast<int>(modes.size()));
  help_on_hover("Trigger", "Aligns the plots to the time at which a signal crosses a level.", style);
  return static_cast<TriggerMode>(mode);
}

void choose_event(TriggerSettings& trigger, const Style& style) {
  same_line_if_room(style.points(150));
  choose_trigger_signal("##signal", trigger.signal, style.points(150), style);
  same_line_if_room(style.points(62));
  const bool rising = trigger.edge == TriggerEdge::rising;
  if (button(rising ? "rising" : "falling", {style.points(62), 0}))
    trigger.edge = rising ? TriggerEdge::falling : TriggerEdge::rising;
  same_line_if_room(style.points(70));
  ImGui::SetNextItemWidth(style.points(70));
  const auto [unit, factor] = shown_unit(protocol::info(trigger.signal).unit);
  float level = factor * trigger.level;
  if (ImGui::DragFloat("##level", &level, 0.01f * factor, 0.0f, 0.0f, "%.3g")) trigger.level = level / factor;
  help_on_hover("Level", unit, style);
  same_line_if_room(style.points(92));
  float percent = 100.0f * trigger.pre_trigger;
  ImGui::SetNextItemWidth(style.points(92));
  if (ImGui::DragFloat("##before", &percent, 0.5f, 0.0f, 100.0f, "%.0f %% before", ImGuiSliderFlags_AlwaysClamp))
    trigger.pre_trigger = percent / 100.0f;
  help_on_hover("Before the event", "Fraction of the time span before the trigger event.", style);
}

void draw_trigger(Timeline& timeline, const Style& style) {
  TriggerSettings trigger = timeline.trigger();
  trigger.mode = choose_mode(trigger.mode, style);
  if (trigger.mode != TriggerMode::off) choose_event(trigger, style);
  if (trigger != timeline.trigger()) timeline.set_trigger(trigger);
  if (trigger.mode != TriggerMode::single) return;
  same_line_if_room(style.points(48));
  if (button("Arm", {style.points(48), 0})) timeline.arm_trigger();
}

}  // namespace

void draw_toolbar(Timeline& timeline, Cursors& cursors, bool& with_statistics, SignalList& signals, bool is_replay,
                  const Style& style) {
  const bool paused = timeline.is_paused();
  // During a replay, the replay bar has the button Pause.
  if (paused || !is_replay) {
    same_line_if_room(style.points(58));
    if (toggle_button(paused ? "Run###pause" : "Pause###pause", paused, style, {style.points(58), 0}))
      timeline.pause(!paused);
    help_on_hover("",
                  "Pause freezes the plots. Then drag to move in time, turn the wheel to zoom, and double-click to "
                  "resume. Key: Ctrl+P",
                  style);
  }
  draw_span(timeline, style);
  same_line_if_room(style.points(66));
  if (toggle_button("Cursors", cursors.are_shown(), style, {style.points(66), 0})) cursors.toggle();
  same_line_if_room(style.points(72));
  if (toggle_button("Statistics", with_statistics, style, {style.points(72), 0})) with_statistics = !with_statistics;
  same_line_if_room(style.points(66));
  if (toggle_button("Signals", signals.is_shown(), style, {style.points(66), 0})) signals.toggle();
  help_on_hover("Signals", "Lists all signals and formulas. Drag a signal into a plot.", style);
  draw_trigger(timeline, style);
  if (!cursors.are_shown()) return;
  const std::string distance = cursors.distance(timeline.span_s());
  same_line_if_room(ImGui::CalcTextSize(distance.c_str()).x);
  ImGui::AlignTextToFramePadding();
  text(style.fonts.caption, style.palette->text, distance);
}

}  // namespace inkwell::window
