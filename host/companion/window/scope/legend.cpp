#include "host/companion/window/scope/legend.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

namespace {

float width_of(const std::string& label, const Style& style) {
  return style.fonts.caption->CalcTextSizeA(style.fonts.caption->FontSize, 1e4f, 0, label.c_str()).x;
}

constexpr float label_margin_points = 24.0f;  // width of a color mark and of a gap

// Returns the index of the first signal on the y axis. In an xy plot, the first signal is on the x axis.
std::size_t first_on_y_axis(const ScopePlot& plot) {
  return plot.kind == PlotKind::xy && plot.signals.size() > 1 ? 1 : 0;
}

// Returns the signal names. If all signals have the same unit, the names do not contain the unit.
std::vector<std::string> names_on_y_axis(const ScopePlot& plot) {
  const bool unit_is_known = !common_unit(plot).empty();
  std::vector<std::string> names;
  for (std::size_t i = first_on_y_axis(plot); i < plot.signals.size(); ++i)
    names.push_back(unit_is_known ? short_name(plot.signals[i]) : std::string(plot.signals[i].name()));
  return names;
}

// Converts "penetration_x" to "x".
std::string last_word(const std::string& name) { return name.substr(name.rfind('_') + 1); }

std::vector<std::string> last_words(const ScopePlot& plot) {
  std::vector<std::string> words;
  for (const ScopeSignal& signal : std::span(plot.signals).subspan(first_on_y_axis(plot)))
    words.push_back(last_word(short_name(signal)));
  return words;
}

bool are_different(std::vector<std::string> words) {
  std::ranges::sort(words);
  return std::ranges::adjacent_find(words) == words.end();
}

/// Labels of a legend, shortened to the available width.
class LegendLabels {
 public:
  LegendLabels(const ScopePlot& plot, const PlotFrame& frame, float room)
      : plot_(plot), frame_(frame), room_(room), names_(names_on_y_axis(plot)) {
    if (fits(names_)) return;
    // In a narrow plot, each label contains only the last word of the signal name.
    if (const std::vector<std::string> words = last_words(plot); words.size() > 1 && are_different(words))
      names_ = words;
    if (fits(names_)) return;
    const float each = room_ / static_cast<float>(names_.size()) - frame.style.points(label_margin_points);
    for (std::string& name : names_) name = fitted(name, each, frame.style.fonts.caption);
  }

  /// While cursors are shown, adds the values at the cursors if the plot is wide enough.
  std::vector<std::string> labels() const {
    if (!frame_.cursors.are_shown() || plot_.kind != PlotKind::time) return names_;
    for (const bool in_full : {true, false}) {
      std::vector<std::string> labels;
      for (std::size_t i = 0; i < names_.size(); ++i) labels.push_back(with_values(i, in_full));
      if (fits(labels)) return labels;
    }
    return names_;
  }

 private:
  bool fits(const std::vector<std::string>& labels) const {
    float wanted = 0.0f;
    for (const std::string& label : labels)
      wanted += width_of(label, frame_.style) + frame_.style.points(label_margin_points);
    return wanted <= room_;
  }

  std::string with_values(std::size_t i, bool in_full) const {
    const SignalSeries* series = frame_.timeline.history().find(plot_.signals[i]);
    if (series == nullptr) return names_[i];
    auto [first, second] = frame_.cursors.values(*series, frame_.stretch);
    const auto factor = static_cast<double>(common_shown_unit(plot_).factor);
    first *= factor;
    second *= factor;
    const std::string difference = formatted(second - first);
    return in_full ? fmt::format("{}  {}  {}  diff. {}", names_[i], formatted(first), formatted(second), difference)
                   : fmt::format("Δ{}  {}", last_word(names_[i]), difference);
  }

  const ScopePlot& plot_;
  const PlotFrame& frame_;
  float room_;
  std::vector<std::string> names_;
};

}  // namespace

std::string short_name(const ScopeSignal& signal) {
  std::string ending = fmt::format("_{}", signal.unit());
  std::ranges::replace(ending, '/', '_');
  std::string name{signal.name()};
  if (!signal.unit().empty() && name.ends_with(ending)) name.resize(name.size() - ending.size());
  return name;
}

std::string common_unit(const ScopePlot& plot) {
  const auto signals = std::span(plot.signals).subspan(first_on_y_axis(plot));
  const std::string_view unit = signals.front().unit();
  const bool is_common = std::ranges::all_of(signals, [&](const ScopeSignal& each) { return each.unit() == unit; });
  return is_common ? std::string(unit) : "";
}

ShownUnit common_shown_unit(const ScopePlot& plot) {
  const auto signals = std::span(plot.signals).subspan(first_on_y_axis(plot));
  return common_unit(plot).empty() ? ShownUnit{""} : shown_unit(signals.front().unit());
}

float legend_width(const ScopePlot& plot, const Style& style) {
  float width = width_of(std::string(common_shown_unit(plot).name), style) + style.points(8);
  for (const std::string& name : names_on_y_axis(plot))
    width += width_of(name, style) + style.points(label_margin_points);
  return width;
}

Colour line_colour(const Style& style, std::size_t index) {
  return style.palette->lines[index % style.palette->lines.size()];
}

Colour laid_over_colour(const Style& style, std::size_t index) {
  constexpr std::uint8_t paler = 120;
  return line_colour(style, index).with_alpha(paler);
}

void draw_legend(const ScopePlot& plot, ImVec2 origin, float width, const PlotFrame& frame) {
  const Style& style = frame.style;
  ImFont* font = style.fonts.caption;
  const ImU32 quiet = packed(style.palette->text_quiet);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string unit(common_shown_unit(plot).name);
  note_text(unit);
  list.AddText(font, font->FontSize, {origin.x + style.points(2), origin.y}, quiet, unit.c_str());
  const float room = width - width_of(unit, style) - style.points(8);
  const std::vector<std::string> labels = LegendLabels(plot, frame, room).labels();

  const float middle = origin.y + 0.5f * font->FontSize + style.points(1);
  float right = origin.x + width;
  for (std::size_t i = labels.size(); i-- > 0;) {
    right -= width_of(labels[i], style);
    if (right < origin.x + style.points(label_margin_points)) break;
    list.AddText(font, font->FontSize, {right, origin.y}, quiet, labels[i].c_str());
    note_text(labels[i]);
    right -= style.points(14);
    list.AddRectFilled({right, middle - style.points(1.5f)}, {right + style.points(9), middle + style.points(1.5f)},
                       packed(line_colour(style, first_on_y_axis(plot) + i)), style.points(1.5f));
    right -= style.points(10);
  }
}

}  // namespace inkwell::window
