// Plots the first signal on the x axis and all other signals on the y axis.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "host/companion/window/frame/widgets.hpp"

#include "host/companion/window/scope/legend.hpp"
#include "host/companion/window/scope/plot_view.hpp"

namespace inkwell::window {

namespace {

constexpr std::uint64_t points_maximum = 4000;

class XyView final : public PlotView {
 public:
  explicit XyView(const ScopePlot& plot)
      : PlotView(plot),
        x_(extent_around_zero(plot.signals.front().unit())),
        y_(extent_around_zero(common_unit(plot))) {}

  void draw(PlotArea area, PlotFrame& frame) override {
    const SignalHistory& history = frame.timeline.history();
    const std::uint64_t first = std::max(frame.stretch.first_index(), history.begin());
    const std::uint64_t last = std::min(frame.stretch.last_index(), history.end());
    find_ranges(area, history, first, last);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    draw_axes(list, area, frame.style, std::string(shown_unit(plot_.signals.front().unit()).name), "");
    draw_name_of_x(list, area, frame.style);
    for (const bool over : {true, false}) draw_lane(list, area, frame, over, first, last);
  }

  PlotTable table(const PlotFrame& frame) const override {
    PlotTable table = PlotView::table(frame);
    if (table.columns.size() != plot_.signals.size()) return {.title = plot_.title};
    table.x_name = table.names.front();
    table.x.assign(table.columns.front().begin(), table.columns.front().end());
    table.names.erase(table.names.begin());
    table.columns.erase(table.columns.begin());
    table.x_increases = false;
    return table;
  }

 private:
  /// Draws the signals. If `over` is true, draws the overlaid recording in paler colors.
  void draw_lane(ImDrawList& list, const PlotArea& area, const PlotFrame& frame, bool over, std::uint64_t first,
                 std::uint64_t last) const {
    const SignalHistory& history = frame.timeline.history();
    const SignalSeries* x_series = series_of(history, 0, over);
    if (x_series == nullptr || first >= last) return;
    const std::uint64_t stride = std::max<std::uint64_t>(1, (last - first) / points_maximum);
    for (std::size_t i = 1; i < plot_.signals.size(); ++i) {
      const SignalSeries* series = series_of(history, i, over);
      if (series == nullptr) continue;
      std::vector<std::pair<double, double>> points;
      for (std::uint64_t at = first; at < last; at += stride) points.emplace_back((*x_series)[at], (*series)[at]);
      draw_points(list, area, points, over ? laid_over_colour(frame.style, i) : line_colour(frame.style, i),
                  frame.style);
    }
  }

  /// Draws the signal name above the end of the x axis.
  void draw_name_of_x(ImDrawList& list, const PlotArea& area, const Style& style) const {
    ImFont* font = style.fonts.caption;
    const std::string name = fitted(short_name(plot_.signals.front()), area.width() - style.points(8), font);
    const ImVec2 taken = font->CalcTextSizeA(font->FontSize, 1e4f, 0, name.c_str());
    list.AddText(font, font->FontSize,
                 {area.maximum.x - taken.x - style.points(4), area.maximum.y - taken.y - style.points(2)},
                 packed(style.palette->text_quiet), name.c_str());
  }

  const SignalSeries* series_of(const SignalHistory& history, std::size_t index, bool over) const {
    return over ? history.find_over(plot_.signals[index]) : history.find(plot_.signals[index]);
  }

  void find_ranges(PlotArea& area, const SignalHistory& history, std::uint64_t first, std::uint64_t last) {
    Extremes x{std::nanf(""), std::nanf("")};
    Extremes y = x;
    for (std::size_t i = 0; i < plot_.signals.size(); ++i) {
      Extremes& all = i == 0 ? x : y;
      for (const bool over : {false, true}) {
        const SignalSeries* series = series_of(history, i, over);
        if (series == nullptr) continue;
        const Extremes each = series->extremes(first, last);
        all = {std::fmin(all.minimum, each.minimum), std::fmax(all.maximum, each.maximum)};
      }
    }
    const double now_s = ImGui::GetTime();
    area.x = x_.update(static_cast<double>(x.minimum), static_cast<double>(x.maximum), now_s);
    area.y = shown_range(y_.update(static_cast<double>(y.minimum), static_cast<double>(y.maximum), now_s));
    area.x_shown_factor = static_cast<double>(shown_unit(plot_.signals.front().unit()).factor);
    area.y_shown_factor = static_cast<double>(common_shown_unit(plot_).factor);
    drawn_x_ = area.x;
    drawn_y_ = area.y;
  }

  SteadyRange x_;
  SteadyRange y_;
};

}  // namespace

std::unique_ptr<PlotView> xy_view(const ScopePlot& plot) { return std::make_unique<XyView>(plot); }

}  // namespace inkwell::window
