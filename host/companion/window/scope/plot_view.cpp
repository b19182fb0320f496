#include "host/companion/window/scope/plot_view.hpp"

#include <algorithm>

#include "protocol/reports.hpp"

namespace inkwell::window {

std::unique_ptr<PlotView> view_of(const ScopePlot& plot) {
  switch (plot.kind) {
    case PlotKind::time: return time_view(plot);
    case PlotKind::spectrum: return spectrum_view(plot);
    case PlotKind::xy: return xy_view(plot);
  }
  return time_view(plot);
}

PlotTable PlotView::table(const PlotFrame& frame) const {
  const SignalHistory& history = frame.timeline.history();
  const std::uint64_t first = std::max(frame.stretch.first_index(), history.begin());
  const std::uint64_t last = std::min(frame.stretch.last_index(), history.end());
  PlotTable table{.title = plot_.title, .x_name = "time_s", .x_range = drawn_x_, .y_range = drawn_y_};
  for (std::uint64_t i = first; i < last; ++i)
    table.x.push_back((static_cast<double>(i) - frame.stretch.zero) / protocol::servo_rate_Hz);
  for (const ScopeSignal& signal : plot_.signals) {
    const SignalSeries* series = history.find(signal);
    if (series == nullptr) continue;
    table.names.emplace_back(signal.name());
    std::vector<float>& column = table.columns.emplace_back();
    column.reserve(table.x.size());
    for (std::uint64_t i = first; i < last; ++i) column.push_back((*series)[i]);
  }
  return table;
}

}  // namespace inkwell::window
