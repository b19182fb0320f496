#include "host/companion/window/scope/scope_pane.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/plot/plot_saver.hpp"
#include "protocol/reports.hpp"

#include "host/companion/window/scope/cursors.hpp"
#include "host/companion/window/scope/layout_menu.hpp"
#include "host/companion/window/scope/legend.hpp"
#include "host/companion/window/scope/plot_menu.hpp"
#include "host/companion/window/scope/plot_view.hpp"
#include "host/companion/window/scope/signal_list.hpp"
#include "host/companion/window/scope/toolbar.hpp"

namespace inkwell::window {

namespace {

constexpr float header_points = 28.0f;
constexpr float y_axis_points = 52.0f;
constexpr float x_axis_points = 21.0f;
constexpr float plot_minimum_width_points = 230.0f;
constexpr float plot_minimum_height_points = 92.0f;
constexpr float title_part_maximum = 0.5f;
constexpr float title_margin_points = 24.0f;

/// Returns the statistics of all plotted signals as lines with tabs, for a spreadsheet.
std::string statistics_text_of(const ScopePlot& plot, const PlotFrame& frame) {
  std::string lines = "signal\tunit\tmean\trms\tdeviation\tminimum\tmaximum\tsamples\n";
  for (const ScopeSignal& signal : plot.signals) {
    const SignalSeries* series = frame.timeline.history().find(signal);
    const Statistics each = series == nullptr
                                ? no_statistics
                                : statistics(*series, frame.stretch.first_index(), frame.stretch.last_index());
    const auto [unit, factor_float] = shown_unit(signal.unit());
    const auto factor = static_cast<double>(factor_float);
    lines += fmt::format("{}\t{}\t{:.7g}\t{:.7g}\t{:.7g}\t{:.7g}\t{:.7g}\t{}\n", short_name(signal), unit,
                         factor * each.mean, factor * each.root_mean_square, factor * each.standard_deviation,
                         factor * each.minimum, factor * each.maximum, each.count);
  }
  return lines;
}

}  // namespace

ScopePane::ScopePane(const ScopeSettings& settings)
    : timeline_(settings.span_s, settings.trigger),
      layout_(settings.layout),
      layout_menu_(std::make_unique<LayoutMenu>(settings.own_layouts)),
      cursors_(std::make_unique<Cursors>()),
      signal_list_(std::make_unique<SignalList>()),
      saver_(std::make_unique<PlotSaver>()) {}

ScopePane::~ScopePane() = default;

ScopeSettings ScopePane::settings() const {
  return {timeline_.span_s(), timeline_.trigger(), layout_, layout_menu_->own_layouts()};
}

std::vector<protocol::Signal> ScopePane::signals() const {
  std::vector<protocol::Signal> result = signals_of(layout_);
  const protocol::Signal trigger = timeline_.trigger().signal;
  if (timeline_.is_triggered() && result.size() < protocol::scope_signals_maximum &&
      std::ranges::find(result, trigger) == result.end())
    result.push_back(trigger);
  return result;
}

void ScopePane::draw(ImVec2 origin, ImVec2 size, const Style& style, bool is_replay) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(12), style.points(8)});
  begin_pane("scope", origin, size, ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  take_keys();
  draw_controls(style, is_replay);
  signal_list_->draw(layout_, style);
  follow_layout();
  timeline_.derive(shown_formulas(layout_));
  PlotFrame frame{style, timeline_, timeline_.stretch(), *cursors_, with_statistics_, judged_end_, has_motion_};
  draw_plots(frame);
  judged_end_ = timeline_.history().end();
  saver_->draw("scope message", origin.y + size.y - style.points(8), style);
  end_pane();
}

void ScopePane::take_keys() {
  constexpr double drag_part = 0.1;  // of the span
  const KeySteps view = key_steps_in_part(with_shift);
  if (view.right != 0) timeline_.drag(-drag_part * view.right);
  if (view.up != 0) timeline_.zoom(view.up, 0.0);
  if (!cursors_->are_shown()) return;
  cursors_->step(0, key_steps_in_part(with_ctrl).right);
  cursors_->step(1, key_steps_in_part(with_ctrl | with_shift).right);
}

void ScopePane::draw_controls(const Style& style, bool is_replay) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{style.points(8), style.points(4.5f)});
  layout_menu_->draw(layout_, style);
  draw_toolbar(timeline_, *cursors_, with_statistics_, *signal_list_, is_replay, style);
  ImGui::PopStyleVar();
}

void ScopePane::follow_layout() {
  std::vector<std::unique_ptr<PlotView>> before = std::exchange(views_, {});
  for (const ScopePlot& plot : layout_.plots) {
    const auto same = std::ranges::find_if(before, [&](const auto& view) { return view && view->plot() == plot; });
    views_.push_back(same == before.end() ? view_of(plot) : std::move(*same));
  }
}

void ScopePane::draw_plots(PlotFrame& frame) {
  // If the pane is too small for all rows, the user can scroll.
  ImGui::BeginChild("plots", {0, 0}, false, ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NavFlattened);
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 gap{frame.style.points(12), frame.style.points(6)};
  const auto count = static_cast<int>(views_.size());
  const int fitting = static_cast<int>((room.x + gap.x) / (frame.style.points(plot_minimum_width_points) + gap.x));
  const int columns = std::clamp(std::min(layout_.columns, fitting), 1, std::max(1, count));
  const int rows = (count + columns - 1) / columns;
  const float width = (room.x - gap.x * static_cast<float>(columns - 1)) / static_cast<float>(columns);
  float numbers = 0.0f;
  for (const auto& view : views_) numbers = std::max(numbers, view->numbers_height(frame));
  const float height_minimum = frame.style.points(plot_minimum_height_points) + numbers;
  const int rows_fitting = static_cast<int>((room.y + gap.y) / (height_minimum + gap.y));
  const auto rows_in_sight = static_cast<float>(std::clamp(rows_fitting, 1, rows));
  const float height = (room.y - gap.y * (rows_in_sight - 1.0f)) / rows_in_sight;
  std::optional<int> removed;
  std::vector<Box> areas;
  for (int i = 0; i < count; ++i) {
    const ImVec2 corner{origin.x + static_cast<float>(i % columns) * (width + gap.x),
                        origin.y + static_cast<float>(i / columns) * (height + gap.y)};
    areas.push_back({corner.x, corner.y, corner.x + width, corner.y + height});
    if (draw_plot(static_cast<std::size_t>(i), corner, {width, height}, frame)) removed = i;
  }
  saver_->set_areas(std::move(areas));
  if (removed) layout_.plots.erase(layout_.plots.begin() + *removed);
  ImGui::EndChild();
}

bool ScopePane::draw_plot(std::size_t index, ImVec2 origin, ImVec2 size, PlotFrame& frame) {
  const Style& style = frame.style;
  PlotView& view = *views_[index];
  ScopePlot& plot = layout_.plots[index];
  ImGui::PushID(static_cast<int>(index));
  ImGui::SetCursorScreenPos(origin);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{style.points(6), style.points(4.5f)});
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_Button, packed(style.palette->pane));
  ImGui::PushFont(style.fonts.strong);
  const float title_room = std::max(title_part_maximum * size.x,
                                    size.x - legend_width(view.plot(), style) - style.points(title_margin_points));
  if (button(fitted(plot.title.empty() ? "Plot" : plot.title, title_room).c_str())) ImGui::OpenPopup("plot menu");
  ImGui::PopFont();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
  const float title_width = ImGui::GetItemRectSize().x;
  help_on_hover("", "Click to choose the signals and the plot type.", style);
  const PlotMenuChoice choice = draw_plot_menu(plot, layout_.formulas, layout_.plots.size() > 1, style);
  carry_out(choice, index, frame);
  draw_legend(view.plot(), {origin.x + title_width, origin.y + style.points(6)}, size.x - title_width - style.points(6),
              frame);

  const float header = style.points(header_points) + view.numbers_height(frame);
  const PlotArea area{{origin.x + style.points(y_axis_points), origin.y + header},
                      {origin.x + size.x - style.points(6), origin.y + size.y - style.points(x_axis_points)},
                      {0, 1},
                      {0, 1}};
  if (area.width() > style.points(40) && area.height() > style.points(24)) {
    ImGui::SetCursorScreenPos(area.minimum);
    ImGui::InvisibleButton("plot", {area.width(), area.height()});
    take_dropped_signal(plot);
    view.draw(area, frame);
    draw_hint(view.plot(), area, style);
  }
  ImGui::PopID();
  return choice == PlotMenuChoice::remove;
}

void ScopePane::carry_out(PlotMenuChoice choice, std::size_t index, const PlotFrame& frame) {
  const ScopePlot& plot = views_[index]->plot();
  if (choice == PlotMenuChoice::none || choice == PlotMenuChoice::remove) return;
  if (choice == PlotMenuChoice::copy_statistics) {
    ImGui::SetClipboardText(statistics_text_of(plot, frame).c_str());
    saver_->show("Copied the statistics.");
    return;
  }
  const PlotFormat format = choice == PlotMenuChoice::save_png   ? PlotFormat::png
                            : choice == PlotMenuChoice::save_svg ? PlotFormat::svg
                                                                 : PlotFormat::csv;
  saver_->ask(format, index, plot.title.empty() ? "plot" : plot.title, [&] { return views_[index]->table(frame); });
}

std::vector<std::pair<std::string, AxisRange>> ScopePane::drawn_ranges() const {
  std::vector<std::pair<std::string, AxisRange>> ranges;
  for (const auto& view : views_) ranges.emplace_back(view->plot().title, view->drawn_y());
  return ranges;
}

void ScopePane::take_dropped_signal(ScopePlot& plot) {
  const auto dropped = dropped_signal();
  if (!dropped) return;
  const auto signal = find_scope_signal(*dropped, layout_.formulas);
  if (signal && std::ranges::find(plot.signals, *signal) == plot.signals.end()) plot.signals.push_back(*signal);
}

void ScopePane::draw_hint(const ScopePlot& plot, const PlotArea& area, const Style& style) const {
  const std::string hint = hint_for(plot, timeline_.history());
  if (hint.empty()) return;
  ImFont* font = style.fonts.caption;
  const float room = std::min(area.width() - style.points(16), style.points(300));
  const ImVec2 taken = font->CalcTextSizeA(font->FontSize, 1e4f, room, hint.c_str());
  const ImVec2 corner{0.5f * (area.minimum.x + area.maximum.x - taken.x),
                      0.5f * (area.minimum.y + area.maximum.y - taken.y)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float margin = style.points(5);
  list.AddRectFilled({corner.x - margin, corner.y - margin}, {corner.x + taken.x + margin, corner.y + taken.y + margin},
                     packed(style.palette->pane), style.points(4));
  list.AddText(font, font->FontSize, corner, packed(style.palette->text_quiet), hint.c_str(), nullptr, room);
  note_text(hint);
}

}  // namespace inkwell::window
