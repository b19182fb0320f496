#include "host/companion/window/scope/plot_menu.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "protocol/signals.hpp"

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

}  // namespace

bool draw_plot_menu(ScopePlot& plot, std::span<const Formula> formulas, bool may_be_removed, const Style& style) {
  static std::string search;
  static constexpr auto kinds = std::to_array<const char*>({"against time", "spectrum", "against each other"});
  static_assert(kinds.size() == plot_kind_count);
  ImGui::SetNextWindowSizeConstraints({style.points(250), 0}, {style.points(330), style.points(420)});
  if (!ImGui::BeginPopup("plot menu")) return false;
  auto kind = static_cast<int>(plot.kind);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::Combo("##kind", &kind, kinds.data(), static_cast<int>(kinds.size())))
    plot.kind = static_cast<PlotKind>(kind);
  const bool is_to_be_removed = may_be_removed && ImGui::Selectable("Remove this plot");
  ImGui::Separator();
  if (ImGui::IsWindowAppearing()) search.clear();
  draw_search(search, style);
  choose_signals(plot, formulas, search, style);
  ImGui::EndPopup();
  return is_to_be_removed;
}

}  // namespace inkwell::window
