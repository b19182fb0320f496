// The scope's controls: toolbar, trigger, and the menu of a pane.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <protocol/reports.hpp>
#include <scope/scope_pane.hpp>

namespace inkwell::window {

namespace {

constexpr std::array<double, 10> spans_s{0.002, 0.01, 0.05, 0.2, 0.5, 1.0, 2.0, 5.0, 20.0, 60.0};

std::string span_label(double span_s) {
  return span_s < 1.0 ? fmt::format("{:.3g} ms", 1000.0 * span_s) : fmt::format("{:.3g} s", span_s);
}

bool choose_signal(const char* label, protocol::Signal& signal, float width) {
  bool chosen = false;
  ImGui::SetNextItemWidth(width);
  if (!ImGui::BeginCombo(label, protocol::info(signal).name.data(), ImGuiComboFlags_HeightLarge)) return false;
  for (const protocol::SignalInfo& info : protocol::signal_table) {
    if (!ImGui::Selectable(info.name.data(), static_cast<protocol::Signal>(info.id) == signal)) continue;
    signal = static_cast<protocol::Signal>(info.id);
    chosen = true;
  }
  ImGui::EndCombo();
  return chosen;
}

}  // namespace

void ScopePane::draw_toolbar(const Style& style) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{style.points(8), style.points(3)});
  draw_layout_menu(style);
  same_line_if_room(style.points(58));
  if (toggle_button(paused_ ? "Run" : "Pause", paused_, style, {style.points(58), 0})) pause(!paused_);
  help_on_hover("", "A pause keeps the picture; drag to move in it, wheel to zoom, double click to run again.", style);
  same_line_if_room(style.points(84));
  ImGui::SetNextItemWidth(style.points(84));
  if (ImGui::BeginCombo("##span", span_label(span_s_).c_str(), ImGuiComboFlags_HeightLarge)) {
    for (double span_s : spans_s)
      if (ImGui::Selectable(span_label(span_s).c_str(), span_s == span_s_)) span_s_ = span_s;
    ImGui::EndCombo();
  }
  help_on_hover("Time shown", "The wheel over a pane changes it too.", style);
  same_line_if_room(style.points(66));
  if (toggle_button("Cursors", cursors_are_shown_, style, {style.points(66), 0}))
    cursors_are_shown_ = !cursors_are_shown_;
  same_line_if_room(style.points(72));
  if (toggle_button("Statistics", statistics_are_shown_, style, {style.points(72), 0}))
    statistics_are_shown_ = !statistics_are_shown_;
  draw_trigger_tools(style);
  if (cursors_are_shown_) {
    const double apart_s = std::abs(cursors_[1] - cursors_[0]) * span_s_;
    const std::string apart = fmt::format("{:.5g} ms, {:.4g} Hz", 1000.0 * apart_s, 1.0 / std::max(apart_s, 1e-9));
    same_line_if_room(ImGui::CalcTextSize(apart.c_str()).x);
    ImGui::AlignTextToFramePadding();
    text(style.fonts.caption, style.palette->text, apart);
  }
  ImGui::PopStyleVar();
}

void ScopePane::draw_trigger_tools(const Style& style) {
  static constexpr std::array<const char*, 3> modes{"no trigger", "trigger", "single"};
  auto mode = static_cast<int>(trigger_settings_.mode);
  same_line_if_room(style.points(100));
  ImGui::SetNextItemWidth(style.points(100));
  if (ImGui::Combo("##mode", &mode, modes.data(), static_cast<int>(modes.size()))) {
    trigger_settings_.mode = static_cast<TriggerMode>(mode);
    trigger_.arm();
  }
  help_on_hover("Trigger", "Aligns the picture to the moment at which a signal crosses a level.", style);
  if (trigger_settings_.mode == TriggerMode::off) return;
  same_line_if_room(style.points(150));
  if (choose_signal("##signal", trigger_settings_.signal, style.points(150))) trigger_.arm();
  same_line_if_room(style.points(62));
  const bool rising = trigger_settings_.edge == TriggerEdge::rising;
  if (button(rising ? "rising" : "falling", {style.points(62), 0})) {
    trigger_settings_.edge = rising ? TriggerEdge::falling : TriggerEdge::rising;
    trigger_.arm();
  }
  same_line_if_room(style.points(70));
  ImGui::SetNextItemWidth(style.points(70));
  if (ImGui::DragFloat("##level", &trigger_settings_.level, 0.01f, 0.0f, 0.0f, "%.3g")) trigger_.arm();
  help_on_hover("Level", std::string(protocol::info(trigger_settings_.signal).unit), style);
  same_line_if_room(style.points(92));
  float percent = 100.0f * trigger_settings_.pre_trigger;
  ImGui::SetNextItemWidth(style.points(92));
  if (ImGui::DragFloat("##before", &percent, 0.5f, 0.0f, 100.0f, "%.0f %% before", ImGuiSliderFlags_AlwaysClamp))
    trigger_settings_.pre_trigger = percent / 100.0f;
  help_on_hover("Before the event", "Part of the picture that lies before the event.", style);
  if (trigger_settings_.mode != TriggerMode::single) return;
  same_line_if_room(style.points(48));
  if (button("Arm", {style.points(48), 0})) trigger_.arm();
}

void ScopePane::draw_pane_menu(std::size_t index, const Style& style) {
  ImGui::SetNextWindowSizeConstraints({style.points(250), 0}, {style.points(330), style.points(420)});
  if (!ImGui::BeginPopup("pane menu")) return;
  Pane& pane = layout_.panes[index];
  static constexpr std::array<const char*, 3> kinds{"against time", "spectrum", "against each other"};
  auto kind = static_cast<int>(pane.kind);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::Combo("##kind", &kind, kinds.data(), static_cast<int>(kinds.size()))) {
    pane.kind = static_cast<PaneKind>(kind);
    memory_[index] = {};
  }
  if (layout_.panes.size() > 1 && ImGui::Selectable("Remove this pane")) removed_pane_ = index;
  ImGui::Separator();
  for (const protocol::SignalInfo& info : protocol::signal_table) {
    const auto signal = static_cast<protocol::Signal>(info.id);
    const auto found = std::ranges::find(pane.signals, signal);
    bool on = found != pane.signals.end();
    const bool is_last = on && pane.signals.size() == 1;
    ImGui::BeginDisabled(is_last);
    if (ImGui::Checkbox(info.name.data(), &on)) {
      if (on) {
        pane.signals.push_back(signal);
      } else {
        pane.signals.erase(found);
      }
      memory_[index] = {};
    }
    ImGui::EndDisabled();
    help_on_hover(info.name, info.help, style);
  }
  ImGui::EndPopup();
}

}  // namespace inkwell::window
