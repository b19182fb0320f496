#include <scope/scope_pane.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <protocol/reports.hpp>

#include "legend.hpp"
#include "signal_line.hpp"

namespace inkwell::window {

namespace {

constexpr double rate_Hz = protocol::servo_rate_Hz;
constexpr double numbers_every_s = 0.2;
constexpr double range_remembered_s = 1.0;  // for telling motion from noise
constexpr float header_points = 24.0f;
constexpr float y_axis_points = 52.0f;
constexpr float x_axis_points = 21.0f;
constexpr float statistics_line_points = 15.0f;
constexpr float pane_minimum_width_points = 230.0f;
constexpr float pane_minimum_height_points = 92.0f;

}  // namespace

ScopePane::ScopePane(const ScopeSettings& settings)
    : trigger_settings_(settings.trigger), own_layouts_(settings.own_layouts), span_s_(settings.span_s) {
  choose_layout(settings.layout);
}

void ScopePane::choose_layout(const ScopeLayout& layout) {
  layout_ = layout;
  memory_.assign(layout_.panes.size(), {});
}

ScopeSettings ScopePane::settings() const { return {span_s_, trigger_settings_, layout_, own_layouts_}; }

std::vector<protocol::Signal> ScopePane::signals() const {
  std::vector<protocol::Signal> result = signals_of(layout_);
  const bool triggered = trigger_settings_.mode != TriggerMode::off;
  if (triggered && result.size() < protocol::scope_signals_maximum &&
      std::ranges::find(result, trigger_settings_.signal) == result.end())
    result.push_back(trigger_settings_.signal);
  return result;
}

void ScopePane::receive(const device::ScopeSamples& samples) {
  if (!paused_) history_.append(samples);
}

void ScopePane::start_anew() {
  history_.clear();
  trigger_.arm();
  paused_ = false;
}

void ScopePane::pause(bool paused) {
  if (paused == paused_) return;
  if (paused) {
    paused_last_ = stretch().last;
  } else {
    start_anew();  // what came during the pause was let go
  }
  paused_ = paused;
}

ScopePane::Stretch ScopePane::stretch() {
  const double span = span_s_ * rate_Hz;
  const auto end = static_cast<double>(history_.end());
  if (paused_) return {paused_last_ - span, paused_last_, end};
  if (trigger_settings_.mode != TriggerMode::off) {
    if (const SignalSeries* series = history_.find(trigger_settings_.signal))
      trigger_.advance(*series, trigger_settings_, span);
    if (const auto event = trigger_.event()) {
      const double first = static_cast<double>(*event) - static_cast<double>(trigger_settings_.pre_trigger) * span;
      return {first, first + span, static_cast<double>(*event)};
    }
  }
  // The right end moves in whole parts of the span, so that the same samples fall into the same column in every
  // frame and the picture rolls without shimmering.
  const double part = std::max(1.0, std::floor(span / 2048.0));
  const double last = std::floor(end / part) * part;
  return {last - span, last, last};
}

void ScopePane::handle_mouse(const PlotArea& area, const Stretch& stretch) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f) {
    const double before_s = span_s_;
    span_s_ = std::clamp(span_s_ * std::exp(-0.15 * static_cast<double>(io.MouseWheel)), ScopeSettings::span_minimum_s,
                         ScopeSettings::span_maximum_s);
    // While paused, what is under the mouse stays under it.
    const double right_part = static_cast<double>((area.maximum.x - io.MousePos.x) / area.width());
    if (paused_) paused_last_ += right_part * (span_s_ - before_s) * rate_Hz;
  }
  if (ImGui::IsItemActive() && io.MouseDelta.x != 0.0f && dragged_cursor_ < 0) {
    if (!paused_) pause(true);
    paused_last_ -= static_cast<double>(io.MouseDelta.x / area.width()) * stretch.span();
    const double begin = static_cast<double>(history_.begin());
    paused_last_ =
        std::clamp(paused_last_, begin, std::max(begin, static_cast<double>(history_.end()) + 0.5 * stretch.span()));
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) pause(false);
}

void ScopePane::draw_cursors(const PlotArea& area, const Style& style) {
  if (!cursors_are_shown_) return;
  const ImGuiIO& io = ImGui::GetIO();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (int i = 0; i < 2; ++i) {
    double& cursor = cursors_[static_cast<std::size_t>(i)];
    const float x = area.maximum.x + static_cast<float>(cursor) * area.width();
    const bool near = ImGui::IsItemHovered() && std::abs(io.MousePos.x - x) < style.points(6);
    if (ImGui::IsItemActivated() && near) dragged_cursor_ = i;
    if (ImGui::IsItemActive() && dragged_cursor_ == i)
      cursor = std::clamp(static_cast<double>((io.MousePos.x - area.maximum.x) / area.width()), -1.0, 0.0);
    if (near) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    list.AddLine({x, area.minimum.y}, {x, area.maximum.y}, packed(style.palette->text.with_alpha(near ? 255 : 150)),
                 style.points(1));
  }
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) dragged_cursor_ = -1;
}

void ScopePane::draw_time(std::size_t index, PlotArea area, const Stretch& stretch, const Style& style) {
  const Pane& pane = layout_.panes[index];
  PaneMemory& memory = memory_[index];
  Extremes all{std::nanf(""), std::nanf("")};
  for (protocol::Signal signal : pane.signals) {
    const SignalSeries* series = history_.find(signal);
    if (series == nullptr || stretch.last <= 0.0) continue;
    const Extremes each = series->extremes(static_cast<std::uint64_t>(std::max(stretch.first, 0.0)),
                                           static_cast<std::uint64_t>(stretch.last));
    all = {std::fmin(all.minimum, each.minimum), std::fmax(all.maximum, each.maximum)};
  }
  area.x = {(stretch.first - stretch.zero) / rate_Hz, (stretch.last - stretch.zero) / rate_Hz};
  area.y = memory.y.update(static_cast<double>(all.minimum), static_cast<double>(all.maximum), ImGui::GetTime());
  judge_motion(pane, area);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_axes(list, area, style, "s", "");
  if (trigger_settings_.mode != TriggerMode::off &&
      std::ranges::find(pane.signals, trigger_settings_.signal) != pane.signals.end()) {
    const float y = area.to_y(static_cast<double>(trigger_settings_.level));
    if (y > area.minimum.y && y < area.maximum.y)
      list.AddLine({area.minimum.x, y}, {area.maximum.x, y}, packed(style.palette->accent.with_alpha(120)),
                   style.points(1));
  }
  for (std::size_t i = 0; i < pane.signals.size(); ++i)
    if (const SignalSeries* series = history_.find(pane.signals[i]))
      draw_signal(list, area, *series, stretch.first, stretch.last, line_colour(style, i), style);

  handle_mouse(area, stretch);
  draw_cursors(area, style);
  if (!statistics_are_shown_) return;
  if (const double now_s = ImGui::GetTime(); now_s - memory.computed_at_s > numbers_every_s) {
    memory.computed_at_s = now_s;
    memory.statistics.clear();
    for (protocol::Signal signal : pane.signals)
      if (const SignalSeries* series = history_.find(signal); series != nullptr && stretch.last > 0.0)
        memory.statistics.push_back(statistics(*series, static_cast<std::uint64_t>(std::max(stretch.first, 0.0)),
                                               static_cast<std::uint64_t>(stretch.last)));
  }
  // Above the plot, where they hide nothing of it.
  ImFont* font = style.fonts.caption;
  float y = area.minimum.y - statistics_height(pane, style);
  for (std::size_t i = 0; i < memory.statistics.size(); ++i, y += style.points(statistics_line_points)) {
    const Statistics& each = memory.statistics[i];
    const std::string line = fmt::format("mean {}   rms {}   deviation {}   {} to {}", formatted(each.mean),
                                         formatted(each.root_mean_square), formatted(each.standard_deviation),
                                         formatted(each.minimum), formatted(each.maximum));
    list.AddText(font, font->FontSize, {area.minimum.x, y}, packed(line_colour(style, i)), line.c_str());
  }
}

float ScopePane::statistics_height(const Pane& pane, const Style& style) const {
  if (!statistics_are_shown_ || pane.kind != PaneKind::time) return 0.0f;
  return style.points(statistics_line_points) * static_cast<float>(pane.signals.size());
}

void ScopePane::judge_motion(const Pane& pane, const PlotArea& area) {
  if (paused_) return;
  const auto span = static_cast<std::uint64_t>(std::max(span_s_, range_remembered_s) * rate_Hz);
  for (protocol::Signal signal : pane.signals) {
    const SignalSeries* series = history_.find(signal);
    if (series == nullptr || judged_end_ == 0) continue;
    const Extremes before = series->extremes(judged_end_ - std::min(judged_end_, span), judged_end_);
    const Extremes newest = series->extremes(judged_end_, series->end());
    has_motion_ |= leaves_range(newest, before, area.y.extent() / static_cast<double>(area.height()));
  }
}

void ScopePane::draw_spectrum(std::size_t index, PlotArea area, const Stretch& stretch, const Style& style) {
  const Pane& pane = layout_.panes[index];
  PaneMemory& memory = memory_[index];
  if (const double now_s = ImGui::GetTime(); now_s - memory.computed_at_s > numbers_every_s && stretch.last > 0.0) {
    memory.computed_at_s = now_s;
    memory.spectra.clear();
    for (protocol::Signal signal : pane.signals) {
      const SignalSeries* series = history_.find(signal);
      memory.spectra.push_back(series == nullptr
                                   ? Spectrum{}
                                   : spectrum(*series, static_cast<std::uint64_t>(std::max(stretch.first, 0.0)),
                                              static_cast<std::uint64_t>(stretch.last)));
    }
  }
  double largest = 1e-9;
  for (const Spectrum& each : memory.spectra)
    for (std::size_t i = 1; i < each.amplitudes.size(); ++i) largest = std::max(largest, each.amplitudes[i]);
  // Decibels below one unit, over four decades of amplitude and three of frequency.
  area.y = memory.y.update(20.0 * std::log10(largest) - 80.0, 20.0 * std::log10(largest), ImGui::GetTime());
  area.x = {1.0, std::log10(0.5 * rate_Hz)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  PlotArea labels = area;
  draw_axes(list, labels, style, "Hz", "dB " + common_unit(pane), true);
  for (std::size_t j = 0; j < memory.spectra.size(); ++j) {
    const Spectrum& each = memory.spectra[j];
    std::vector<std::pair<double, double>> points;
    // The largest line of each pixel's column.
    float column = -1.0f;
    for (std::size_t i = 1; i < each.amplitudes.size(); ++i) {
      const double x = std::log10(each.resolution_Hz * static_cast<double>(i));
      const double y = 20.0 * std::log10(std::max(each.amplitudes[i], 1e-12));
      if (x < area.x.minimum) continue;
      const float pixel = std::floor(area.to_x(x));
      if (pixel == column) {
        points.back().second = std::max(points.back().second, y);
      } else {
        points.emplace_back(x, y);
        column = pixel;
      }
    }
    draw_points(list, area, points, line_colour(style, j), style);
  }
}

void ScopePane::draw_xy(std::size_t index, PlotArea area, const Stretch& stretch, const Style& style) {
  constexpr std::uint64_t points_maximum = 4000;
  const Pane& pane = layout_.panes[index];
  PaneMemory& memory = memory_[index];
  const SignalSeries* x_series = history_.find(pane.signals.front());
  const auto first = static_cast<std::uint64_t>(std::max({stretch.first, static_cast<double>(history_.begin()), 0.0}));
  const auto last = std::min(static_cast<std::uint64_t>(std::max(stretch.last, 0.0)), history_.end());
  Extremes x{std::nanf(""), std::nanf("")};
  Extremes y = x;
  if (x_series != nullptr) x = x_series->extremes(first, last);
  for (std::size_t i = 1; i < pane.signals.size(); ++i)
    if (const SignalSeries* series = history_.find(pane.signals[i])) {
      const Extremes each = series->extremes(first, last);
      y = {std::fmin(y.minimum, each.minimum), std::fmax(y.maximum, each.maximum)};
    }
  area.x = memory.x.update(static_cast<double>(x.minimum), static_cast<double>(x.maximum), ImGui::GetTime());
  area.y = memory.y.update(static_cast<double>(y.minimum), static_cast<double>(y.maximum), ImGui::GetTime());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_axes(list, area, style, std::string(protocol::info(pane.signals.front()).unit),
            pane.signals.size() > 1 ? std::string(protocol::info(pane.signals[1]).unit) : "");
  if (x_series == nullptr || first >= last) return;
  const std::uint64_t stride = std::max<std::uint64_t>(1, (last - first) / points_maximum);
  for (std::size_t j = 1; j < pane.signals.size(); ++j) {
    const SignalSeries* series = history_.find(pane.signals[j]);
    if (series == nullptr) continue;
    std::vector<std::pair<double, double>> points;
    for (std::uint64_t i = first; i < last; i += stride) points.emplace_back((*x_series)[i], (*series)[i]);
    draw_points(list, area, points, line_colour(style, j), style);
  }
}

void ScopePane::draw_pane(std::size_t index, ImVec2 place, ImVec2 size, const Stretch& stretch, const Style& style) {
  const Pane& pane = layout_.panes[index];
  ImGui::PushID(static_cast<int>(index));
  ImGui::SetCursorScreenPos({place.x, place.y - style.points(1)});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{style.points(6), style.points(2)});
  ImGui::PushStyleColor(ImGuiCol_Button, packed(style.palette->panel));
  ImGui::PushFont(style.fonts.strong);
  if (button((pane.title.empty() ? "Pane" : pane.title).c_str())) ImGui::OpenPopup("pane menu");
  ImGui::PopFont();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  const float title_width = ImGui::GetItemRectSize().x;
  help_on_hover("", "Click to choose what this pane shows.", style);
  draw_pane_menu(index, style);
  draw_legend(index, {place.x + title_width, place.y + style.points(4)}, size.x - title_width - style.points(6),
              stretch, style);

  const float header = style.points(header_points) + statistics_height(pane, style);
  const PlotArea area{{place.x + style.points(y_axis_points), place.y + header},
                      {place.x + size.x - style.points(6), place.y + size.y - style.points(x_axis_points)},
                      {0, 1},
                      {0, 1}};
  if (area.width() > style.points(40) && area.height() > style.points(24)) {
    ImGui::SetCursorScreenPos(area.minimum);
    ImGui::InvisibleButton("plot", {area.width(), area.height()});
    switch (pane.kind) {
      case PaneKind::time: draw_time(index, area, stretch, style); break;
      case PaneKind::spectrum: draw_spectrum(index, area, stretch, style); break;
      case PaneKind::xy: draw_xy(index, area, stretch, style); break;
    }
  }
  ImGui::PopID();
}

void ScopePane::draw_panes(const Stretch& shown, const Style& style) {
  // Where there is too little room for all of them, they keep a size that can be read, and the panel scrolls.
  ImGui::BeginChild("panes", {0, 0}, false, ImGuiWindowFlags_NoScrollWithMouse);
  const ImVec2 place = ImGui::GetCursorScreenPos();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 gap{style.points(12), style.points(6)};
  const auto count = static_cast<int>(layout_.panes.size());
  const int fitting = static_cast<int>((room.x + gap.x) / (style.points(pane_minimum_width_points) + gap.x));
  const int columns = std::clamp(std::min(layout_.columns, fitting), 1, std::max(1, count));
  const int rows = (count + columns - 1) / columns;
  const float width = (room.x - gap.x * static_cast<float>(columns - 1)) / static_cast<float>(columns);
  float numbers = 0.0f;
  for (const Pane& pane : layout_.panes) numbers = std::max(numbers, statistics_height(pane, style));
  const float height = std::max((room.y - gap.y * static_cast<float>(rows - 1)) / static_cast<float>(rows),
                                std::min(room.y, style.points(pane_minimum_height_points) + numbers));
  for (int i = 0; i < count; ++i)
    draw_pane(static_cast<std::size_t>(i),
              {place.x + static_cast<float>(i % columns) * (width + gap.x),
               place.y + static_cast<float>(i / columns) * (height + gap.y)},
              {width, height}, shown, style);
  ImGui::EndChild();
}

void ScopePane::draw(ImVec2 place, ImVec2 size, const Style& style) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style.points(12), style.points(8)});
  begin_pane("scope", place, size, ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  draw_toolbar(style);
  const Stretch shown = stretch();
  draw_panes(shown, style);
  judged_end_ = history_.end();
  if (removed_pane_) {
    layout_.panes.erase(layout_.panes.begin() + static_cast<std::ptrdiff_t>(*removed_pane_));
    memory_.erase(memory_.begin() + static_cast<std::ptrdiff_t>(*removed_pane_));
    removed_pane_.reset();
  }
  end_pane();
}

}  // namespace inkwell::window
