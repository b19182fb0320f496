#include "plot_menu.hpp"

#include <algorithm>
#include <array>

#include <frame/widgets.hpp>
#include <protocol/signals.hpp>

namespace inkwell::window {

namespace {

void choose_signals(ScopePlot& plot, const Style& style) {
  for (const protocol::SignalInfo& info : protocol::known_signals()) {
    const auto signal = static_cast<protocol::Signal>(info.id);
    const auto found = std::ranges::find(plot.signals, signal);
    bool on = found != plot.signals.end();
    const bool is_last = on && plot.signals.size() == 1;
    ImGui::BeginDisabled(is_last);
    if (ImGui::Checkbox(info.name.data(), &on)) {
      if (on) {
        plot.signals.push_back(signal);
      } else {
        plot.signals.erase(found);
      }
    }
    ImGui::EndDisabled();
    help_on_hover(info.name, info.help, style);
  }
}

}  // namespace

bool draw_plot_menu(ScopePlot& plot, bool may_be_removed, const Style& style) {
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
  choose_signals(plot, style);
  ImGui::EndPopup();
  return is_to_be_removed;
}

}  // namespace inkwell::window
