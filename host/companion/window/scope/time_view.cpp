// View of signals over time, with trigger level, cursors and statistics.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/scope/analysis.hpp"
#include "protocol/reports.hpp"

#include "host/companion/window/scope/legend.hpp"
#include "host/companion/window/scope/plot_view.hpp"
#include "host/companion/window/scope/signal_line.hpp"
#include "host/companion/window/scope/statistics_text.hpp"

namespace inkwell::window {

namespace {

constexpr double rate_Hz = protocol::servo_rate_Hz;
constexpr double range_remembered_s = 1.0;  // used to distinguish motion from noise
constexpr float statistics_line_points = 15.0f;

class TimeView final : public PlotView {
 public:
  explicit TimeView(const ScopePlot& plot) : PlotView(plot), y_(extent_around_zero(common_unit(plot))) {}

  float numbers_height(const PlotFrame& frame) const override {
    if (!frame.with_statistics) return 0.0f;
    return frame.style.points(statistics_line_points) * static_cast<float>(plot_.signals.size());
  }

  void draw(PlotArea area, PlotFrame& frame) override {
    const auto& [first, last, zero] = frame.stretch;
    const Extremes all = extremes(frame);
    area.x = {(first - zero) / rate_Hz, (last - zero) / rate_Hz};
    area.y =
        shown_range(y_.update(static_cast<double>(all.minimum), static_cast<double>(all.maximum), ImGui::GetTime()));
    area.y_shown_factor = static_cast<double>(common_shown_unit(plot_).factor);
    drawn_x_ = area.x;
    drawn_y_ = area.y;
    judge_motion(area, frame);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    draw_axes(list, area, frame.style, "s", "");
    draw_trigger_level(list, area, frame);
    const std::vector<std::size_t> order = drawing_order(plot_.signals);
    for (const std::size_t i : order)
      if (const SignalSeries* series = frame.timeline.history().find_over(plot_.signals[i]))
        draw_signal(list, area, *series, first, last, laid_over_colour(frame.style, i), frame.style);
    for (const std::size_t i : order)
      if (const SignalSeries* series = frame.timeline.history().find(plot_.signals[i]))
        draw_signal(list, area, *series, first, last, line_colour(frame.style, i), frame.style);
    draw_fault(list, area, frame);  // no line crosses the label
    take_mouse(area, frame);
    frame.cursors.draw(area, frame.style);
    if (frame.with_statistics) draw_statistics(list, area, frame);
  }

 private:
  Extremes extremes(const PlotFrame& frame) const {
    Extremes all{std::nanf(""), std::nanf("")};
    if (frame.stretch.last <= 0.0) return all;
    const SignalHistory& history = frame.timeline.history();
    for (const ScopeSignal& signal : plot_.signals)
      for (const SignalSeries* series : {history.find(signal), history.find_over(signal)}) {
        if (series == nullptr) continue;
        const Extremes each = series->extremes(frame.stretch.first_index(), frame.stretch.last_index());
        all = {std::fmin(all.minimum, each.minimum), std::fmax(all.maximum, each.maximum)};
      }
    return all;
  }

  void judge_motion(const PlotArea& area, PlotFrame& frame) const {
    const std::uint64_t end = frame.judged_end;
    if (frame.timeline.is_paused() || end == 0) return;
    const auto remembered = static_cast<std::uint64_t>(std::max(frame.timeline.span_s(), range_remembered_s) * rate_Hz);
    for (const ScopeSignal& signal : plot_.signals) {
      const SignalSeries* series = frame.timeline.history().find(signal);
      if (series == nullptr) continue;
      const Extremes before = series->extremes(end - std::min(end, remembered), end);
      const Extremes newest = series->extremes(end, series->end());
      frame.has_motion |= leaves_range(newest, before, area.y.extent() / static_cast<double>(area.height()));
    }
  }

  void draw_trigger_level(ImDrawList& list, const PlotArea& area, const PlotFrame& frame) const {
    const TriggerSettings& trigger = frame.timeline.trigger();
    if (!frame.timeline.is_triggered() ||
        std::ranges::find(plot_.signals, ScopeSignal(trigger.signal)) == plot_.signals.end())
      return;
    const float y = area.to_y(static_cast<double>(trigger.level));
    if (y <= area.minimum.y || y >= area.maximum.y) return;
    list.AddLine({area.minimum.x, y}, {area.maximum.x, y}, packed(frame.style.palette->accent.with_alpha(120)),
                 frame.style.points(1));
  }

  // Draws a vertical line at the control period of the last fault.
  static void draw_fault(ImDrawList& list, const PlotArea& area, const PlotFrame& frame) {
    const auto fault = frame.timeline.fault();
    if (!fault) return;
    const double index = static_cast<double>(*fault);
    if (index < frame.stretch.first || index > frame.stretch.last) return;
    const float x = area.to_x((index - frame.stretch.zero) / rate_Hz);
    const Style& style = frame.style;
    list.AddLine({x, area.minimum.y}, {x, area.maximum.y}, packed(style.palette->danger_text), style.points(1.5f));
    // The toolbar does not change, so that no button moves under the pointer.
    const char* label = frame.timeline.is_frozen_at_fault() ? "Frozen at the fault" : "fault";
    ImFont* font = style.fonts.caption;
    const ImVec2 taken = font->CalcTextSizeA(font->FontSize, 1e4f, 0, label);
    const float margin = style.points(4);
    const float left = x + margin + taken.x <= area.maximum.x ? x + margin : x - margin - taken.x;
    list.AddRectFilled({left - 2, area.minimum.y}, {left + taken.x + 2, area.minimum.y + taken.y},
                       packed(style.palette->pane.with_alpha(200)));
    list.AddText(font, font->FontSize, {left, area.minimum.y}, packed(style.palette->danger_text), label);
    note_text(label);
    note_area("fault", {x, area.minimum.y}, {x, area.maximum.y});
  }

  // The mouse wheel zooms, a drag moves the displayed section, and a double click returns to the newest samples.
  static void take_mouse(const PlotArea& area, PlotFrame& frame) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f)
      frame.timeline.zoom(static_cast<double>(io.MouseWheel),
                          static_cast<double>((area.maximum.x - io.MousePos.x) / area.width()));
    if (ImGui::IsItemActive() && io.MouseDelta.x != 0.0f && !frame.cursors.is_dragged())
      frame.timeline.drag(static_cast<double>(io.MouseDelta.x / area.width()));
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) frame.timeline.pause(false);
  }

  // Draws the statistics above the plot.
  void draw_statistics(ImDrawList& list, const PlotArea& area, const PlotFrame& frame) {
    if (const double now_s = ImGui::GetTime(); now_s - computed_at_s_ > computed_every_s) {
      computed_at_s_ = now_s;
      statistics_.clear();
      for (const ScopeSignal& signal : plot_.signals)
        if (const SignalSeries* series = frame.timeline.history().find(signal);
            series != nullptr && frame.stretch.last > 0.0)
          statistics_.push_back(statistics(*series, frame.stretch.first_index(), frame.stretch.last_index()));
        else
          statistics_.push_back(no_statistics);
    }
    ImFont* font = frame.style.fonts.caption;
    float y = area.minimum.y - numbers_height(frame);
    const std::vector<std::string> lines = fitted_lines(area.width(), font);
    for (std::size_t i = 0; i < lines.size(); ++i, y += frame.style.points(statistics_line_points)) {
      list.AddText(font, font->FontSize, {area.minimum.x, y}, packed(line_colour(frame.style, i)), lines[i].c_str());
      note_text(lines[i]);
    }
  }

  // Returns a line per signal. All lines have the same form, the longest form that is not wider than `width`.
  std::vector<std::string> fitted_lines(float width, ImFont* font) const {
    std::vector<std::vector<std::string>> forms;
    for (std::size_t i = 0; i < statistics_.size(); ++i)
      forms.push_back(statistics_lines(statistics_[i], shown_unit(plot_.signals[i].unit())));
    std::vector<std::string> lines;
    for (std::size_t form = 0; !forms.empty() && form < forms.front().size(); ++form) {
      lines.clear();
      bool fit = true;
      for (const auto& each : forms) {
        fit &= font->CalcTextSizeA(font->FontSize, 1e4f, 0, each[form].c_str()).x <= width;
        lines.push_back(fitted(each[form], width, font));
      }
      if (fit) break;
    }
    return lines;
  }

  SteadyRange y_;
  std::vector<Statistics> statistics_;
  double computed_at_s_ = -1.0;
};

}  // namespace

std::unique_ptr<PlotView> time_view(const ScopePlot& plot) { return std::make_unique<TimeView>(plot); }

}  // namespace inkwell::window
