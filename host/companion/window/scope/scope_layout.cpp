#include "host/companion/window/scope/scope_layout.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/reports.hpp"

namespace inkwell::window {

std::span<const ScopeLayout> built_in_layouts() {
  using enum protocol::Signal;
  using enum PlotKind;
  static const Formula penetration{
      .name = "penetration_m", .text = "sqrt(penetration_x_m^2 + penetration_y_m^2 + penetration_z_m^2)", .unit = "m"};
  static const std::array<ScopeLayout, 6> layouts{{
      {"contact", 2, {{time, "Position", {position_x_m, position_y_m, position_z_m}}, {time, "Force", {force_N}}}},
      {"paper",
       2,
       {{time, "Figure 11: penetration", {penetration_x_m, penetration_y_m, penetration_z_m}},
        {time, "Figure 12: force", {force_N}},
        {time, "Figure 13: torques", {torque_1_Nm, torque_2_Nm, torque_3_Nm}},
        {time, "Figure 14: duty", {duty_1, duty_2, duty_3}}}},
      {"wall",
       3,
       {{xy, "Force against penetration", {ScopeSignal(penetration), force_N}},
        {time, "Penetration", {ScopeSignal(penetration)}},
        {time, "Force", {force_N}}},
       {penetration}},
      {"currents",
       2,
       {{time, "Motor 1", {current_reference_1_A, current_1_A}},
        {time, "Motor 2", {current_reference_2_A, current_2_A}},
        {time, "Motor 3", {current_reference_3_A, current_3_A}},
        {spectrum, "Spectrum of the currents", {current_1_A, current_2_A, current_3_A}}}},
      {"overview",
       4,
       {{time, "Position", {position_x_m, position_y_m, position_z_m}},
        {time, "Velocity", {velocity_x_m_s, velocity_y_m_s, velocity_z_m_s}},
        {time, "Penetration", {penetration_x_m, penetration_y_m, penetration_z_m}},
        {time, "Force", {force_N}},
        {time, "Torques", {torque_1_Nm, torque_2_Nm, torque_3_Nm}},
        {time, "Currents", {current_1_A, current_2_A, current_3_A}},
        {time, "Duty", {duty_1, duty_2, duty_3}},
        {time, "Control interrupt", {servo_cycles}}}},
      {"interrupt",
       2,
       {{time, "Control interrupt", {servo_cycles}},
        {time,
         "Its stages",
         {stage_sample_cycles, stage_pose_cycles, stage_contact_cycles, stage_torque_cycles, stage_current_cycles,
          stage_report_cycles}}}},
  }};
  return layouts;
}

namespace {

const ScopeLayout* find_built_in(std::string_view name) {
  const auto layouts = built_in_layouts();
  const auto found = std::ranges::find(layouts, name, &ScopeLayout::name);
  return found == layouts.end() ? nullptr : &*found;
}

}  // namespace

const ScopeLayout& built_in_layout(std::string_view name) {
  const ScopeLayout* found = find_built_in(name);
  return found == nullptr ? built_in_layouts().front() : *found;
}

OwnLayouts::OwnLayouts(std::vector<ScopeLayout> layouts) {
  for (ScopeLayout& layout : layouts)
    if (refusal(layout.name).empty()) save(std::move(layout));
}

const ScopeLayout* OwnLayouts::find(std::string_view name) const {
  const auto found = std::ranges::find(layouts_, name, &ScopeLayout::name);
  return found == layouts_.end() ? nullptr : &*found;
}

std::string OwnLayouts::refusal(std::string_view name) {
  if (name.find_first_not_of(' ') == std::string_view::npos) return "Enter a name for the layout.";
  if (find_built_in(name) != nullptr)
    return fmt::format("The built-in layout \"{}\" cannot be replaced. Choose another name.", name);
  return {};
}

void OwnLayouts::save(ScopeLayout layout) {
  const auto found = std::ranges::find(layouts_, layout.name, &ScopeLayout::name);
  if (found == layouts_.end())
    layouts_.push_back(std::move(layout));
  else
    *found = std::move(layout);
}

std::string OwnLayouts::rename(std::string_view from, std::string_view to) {
  if (from == to) return {};
  if (std::string reason = refusal(to); !reason.empty()) return reason;
  if (find(to) != nullptr) return fmt::format("A layout named \"{}\" already exists. Choose another name.", to);
  if (const auto found = std::ranges::find(layouts_, from, &ScopeLayout::name); found != layouts_.end())
    found->name = std::string(to);
  return {};
}

void OwnLayouts::remove(std::string_view name) {
  std::erase_if(layouts_, [name](const ScopeLayout& layout) { return layout.name == name; });
}

const ScopeLayout* find_layout(std::string_view name, const OwnLayouts& own) {
  const ScopeLayout* found = own.find(name);
  return found == nullptr ? find_built_in(name) : found;
}

std::string layout_names(const OwnLayouts& own) {
  std::vector<std::string_view> names;
  for (const ScopeLayout& layout : built_in_layouts()) names.push_back(layout.name);
  for (const ScopeLayout& layout : own.all()) names.push_back(layout.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const ScopeLayout& layout_named(std::string_view name, const OwnLayouts& own) {
  const ScopeLayout* found = find_layout(name, own);
  return found == nullptr ? built_in_layouts().front() : *found;
}

std::optional<ScopeSignal> find_scope_signal(std::string_view name, std::span<const Formula> formulas) {
  if (const auto signal = protocol::find_signal(name)) return *signal;
  const auto found = std::ranges::find(formulas, name, &Formula::name);
  return found == formulas.end() ? std::nullopt : std::optional(ScopeSignal(*found));
}

void put_formula(ScopeLayout& layout, const Formula& formula, std::string_view before) {
  const auto found = std::ranges::find(layout.formulas, before, &Formula::name);
  if (found == layout.formulas.end()) {
    layout.formulas.push_back(formula);
    return;
  }
  const ScopeSignal old(*found);
  *found = formula;
  for (ScopePlot& plot : layout.plots) std::ranges::replace(plot.signals, old, ScopeSignal(formula));
}

void remove_formula(ScopeLayout& layout, std::string_view name) {
  const auto found = std::ranges::find(layout.formulas, name, &Formula::name);
  if (found == layout.formulas.end()) return;
  const ScopeSignal gone(*found);
  layout.formulas.erase(found);
  for (ScopePlot& plot : layout.plots) std::erase(plot.signals, gone);
  std::erase_if(layout.plots, [](const ScopePlot& plot) { return plot.signals.empty(); });
  if (layout.plots.empty()) layout.plots.push_back({PlotKind::time, "Force", {protocol::Signal::force_N}});
}

std::vector<ScopeSignal> shown_formulas(const ScopeLayout& layout) {
  std::vector<ScopeSignal> shown;
  for (const ScopePlot& plot : layout.plots)
    for (const ScopeSignal& signal : plot.signals)
      if (signal.formula() != nullptr && std::ranges::find(shown, signal) == shown.end()) shown.push_back(signal);
  return shown;
}

std::string hint_for(const ScopePlot& plot, const SignalHistory& history) {
  if (plot.kind == PlotKind::xy && plot.signals.size() < 2)
    return "This plot needs a second signal. Drag the signal from Signals into the plot, or click the title.";
  if (history.end() == history.begin()) return "No samples received yet. Connect a device or open a recording.";
  for (const ScopeSignal& signal : plot.signals)
    if (history.find(signal) == nullptr)
      return fmt::format(
          "{} is not among the received signals. Click the title to choose another signal, or record this signal.",
          signal.name());
  return {};
}

std::vector<protocol::Signal> signals_of(const ScopeLayout& layout) {
  std::vector<protocol::Signal> signals;
  for (const ScopePlot& plot : layout.plots)
    for (const ScopeSignal& shown : plot.signals)
      for (const protocol::Signal signal : shown.inputs())
        if (signals.size() < protocol::scope_signals_maximum && std::ranges::find(signals, signal) == signals.end())
          signals.push_back(signal);
  return signals;
}

}  // namespace inkwell::window
