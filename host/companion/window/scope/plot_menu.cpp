#include "host/companion/window/scope/plot_menu.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/plot/plot_saver.hpp"
#include "protocol/signals.hpp"

#include "host/companion/window/scope/legend.hpp"
#include "host/companion/window/scope/signal_list.hpp"

namespace inkwell::window {

namespace {

void choose_signal(ScopePlot& plot, const ScopeSignal& signal, const Style& style) {
  const auto found = std::ranges::find(plot.signals, signal);
  bool on = found != plot.signals.end();
  const bool is_last = on && plot.signals.size() == 1;
  ImGui::BeginDisabled(is_last);
  if (ImGui::Checkbox(std::string(signal.name()).c_str(), &on)) {
    if (on) {
      plot.signals.push_back(signal);
    } else {
      plot.signals.erase(found);
    }
  }
  note_item(signal.name());
  ImGui::EndDisabled();
  help_on_hover(signal.name(), signal.help(), style);
}

void choose_signals(ScopePlot& plot, std::span<const Formula> formulas, const std::string& search, const Style& style) {
  const std::vector<SignalGroup> groups = signal_groups(search);
  for (const SignalGroup& group : groups) {
    text(style.fonts.strong, style.palette->text, group.title);
    for (const protocol::Signal signal : group.signals) choose_signal(plot, signal, style);
  }
  if (!formulas.empty()) text(style.fonts.strong, style.palette->text, "Formulas");
  for (const Formula& formula : formulas) choose_signal(plot, ScopeSignal(formula), style);
  if (groups.empty()) wrapped_text(style.palette->text_quiet, nothing_found);
}

/// Draws the controls of the fixed y range.
void draw_range(ScopePlot& plot, const Style& style) {
  bool is_fixed = plot.fixed_range.has_value();
  if (ImGui::Checkbox("Fixed y range", &is_fixed))
    plot.fixed_range = is_fixed ? std::optional(FixedRange{-1.0, 1.0}) : std::nullopt;
  note_item("Fixed y range");
  help_on_hover("Fixed y range", "The range of the y axis does not follow the signals.", style);
  if (!plot.fixed_range) return;
  const ShownUnit unit = plot.kind == PlotKind::spectrum ? ShownUnit{"dB"} : common_shown_unit(plot);
  const auto factor = static_cast<double>(unit.factor);
  static std::array<double, 2> typed{};  // at most one menu is open
  static bool is_typing = false;
  if (!is_typing) typed = {factor * plot.fixed_range->minimum, factor * plot.fixed_range->maximum};
  is_typing = false;
  bool is_changed = false;
  const auto field = [&](const char* label, const char* name, double& value) {
    ImGui::SetNextItemWidth(0.4f * style.points(250));
    ImGui::InputDouble(label, &value, 0, 0, "%.6g");
    is_typing |= ImGui::IsItemActive();
    is_changed |= ImGui::IsItemDeactivatedAfterEdit();
    note_item(name);
    ImGui::SameLine();
  };
  field("##minimum", "range minimum", typed[0]);
  field("##maximum", "range maximum", typed[1]);
  text(style.fonts.caption, style.palette->text_quiet, unit.name);
  if (is_changed && typed[0] < typed[1]) plot.fixed_range = FixedRange{typed[0] / factor, typed[1] / factor};
}

}  // namespace

PlotMenuChoice draw_plot_menu(ScopePlot& plot, std::span<const Formula> formulas, bool may_be_removed,
                              const Style& style) {
  static std::string search;
  static std::vector<ScopeSignal> plotted;  // at the opening of the menu, so that no row moves during a choice
  static constexpr auto kinds = std::to_array<const char*>({"against time", "spectrum", "against each other"});
  static_assert(kinds.size() == plot_kind_count);
  ImGui::SetNextWindowSizeConstraints({style.points(250), 0}, {style.points(330), style.points(460)});
  if (!ImGui::BeginPopup("plot menu")) return PlotMenuChoice::none;
  if (ImGui::IsWindowAppearing()) {
    search.clear();
    plotted = plot.signals;
  }
  auto kind = static_cast<int>(plot.kind);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::Combo("##kind", &kind, kinds.data(), static_cast<int>(kinds.size())))
    plot.kind = static_cast<PlotKind>(kind);
  draw_range(plot, style);
  ImGui::Separator();
  text(style.fonts.strong, style.palette->text, "Plotted");
  ImGui::PushID("plotted");
  for (const ScopeSignal& signal : plotted) choose_signal(plot, signal, style);
  ImGui::PopID();
  ImGui::Separator();
  auto choice = PlotMenuChoice::none;
  const auto offer = [&](const char* label, PlotMenuChoice offered) {
    if (ImGui::Selectable(label)) choice = offered;
    note_item(label);
  };
  if (const auto format = choose_plot_format())
    choice = *format == PlotFormat::png   ? PlotMenuChoice::save_png
             : *format == PlotFormat::svg ? PlotMenuChoice::save_svg
                                          : PlotMenuChoice::save_csv;
  offer("Copy statistics", PlotMenuChoice::copy_statistics);
  if (may_be_removed) offer("Remove this plot", PlotMenuChoice::remove);
  ImGui::Separator();
  draw_search(search, style);
  choose_signals(plot, formulas, search, style);
  ImGui::EndPopup();
  return choice;
}

}  // namespace inkwell::window
