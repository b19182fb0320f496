#include "legend.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <frame/widgets.hpp>

namespace inkwell::window {

namespace {

float width_of(const std::string& label, const Style& style) {
  return style.fonts.caption->CalcTextSizeA(style.fonts.caption->FontSize, 1e4f, 0, label.c_str()).x;
}

// "force_N" -> "force": the unit stands beside the plot's title if all its signals have the same.
std::string short_name(const ScopeSignal& signal, bool unit_is_told) {
  std::string ending = fmt::format("_{}", signal.unit());
  std::ranges::replace(ending, '/', '_');
  std::string name{signal.name()};
  if (unit_is_told && !signal.unit().empty() && name.ends_with(ending)) name.resize(name.size() - ending.size());
  return name;
}

// "penetration_x" -> "x"
std::string last_word(const std::string& name) { return name.substr(name.rfind('_') + 1); }

/// The labels of one legend, made to fit.
class LegendLabels {
 public:
  LegendLabels(const ScopePlot& plot, const ScopeFrame& frame, float room, bool unit_is_told)
      : plot_(plot), frame_(frame), room_(room) {
    for (const ScopeSignal& signal : plot.signals) names_.push_back(short_name(signal, unit_is_told));
    // Where the plot is narrow its title tells the rest.
    if (unit_is_told && !fits(names_) && names_.size() > 1)
      for (std::string& name : names_) name = last_word(name);
    if (fits(names_)) return;
    const float each = room_ / static_cast<float>(names_.size()) - frame.style.points(24);
    for (std::string& name : names_) name = fitted(name, each, frame.style.fonts.caption);
  }

  /// With cursors, as much of their values as there is room for: both and the difference, that alone, or nothing.
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
    for (const std::string& label : labels) wanted += width_of(label, frame_.style) + frame_.style.points(24);
    return wanted <= room_;
  }

  std::string with_values(std::size_t i, bool in_full) const {
    const SignalSeries* series = frame_.timeline.history().find(plot_.signals[i]);
    if (series == nullptr) return names_[i];
    const auto [first, second] = frame_.cursors.values(*series, frame_.stretch);
    const std::string difference = formatted(second - first);
    return in_full ? fmt::format("{}  {}  {}  diff. {}", names_[i], formatted(first), formatted(second), difference)
                   : fmt::format("Δ{}  {}", last_word(names_[i]), difference);
  }

  const ScopePlot& plot_;
  const ScopeFrame& frame_;
  float room_;
  std::vector<std::string> names_;
};

}  // namespace

std::string formatted(double value) { return std::isnan(value) ? "—" : fmt::format("{:.4g}", value); }

std::string common_unit(const ScopePlot& plot) {
  const std::string_view unit = plot.signals.front().unit();
  for (const ScopeSignal& signal : plot.signals)
    if (signal.unit() != unit) return "";
  return std::string(unit);
}

Colour line_colour(const Style& style, std::size_t index) {
  return style.palette->lines[index % style.palette->lines.size()];
}

Colour laid_over_colour(const Style& style, std::size_t index) {
  constexpr std::uint8_t paler = 120;
  return line_colour(style, index).with_alpha(paler);
}

void draw_legend(const ScopePlot& plot, ImVec2 place, float width, const ScopeFrame& frame) {
  const Style& style = frame.style;
  ImFont* font = style.fonts.caption;
  const ImU32 quiet = packed(style.palette->text_quiet);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string unit = common_unit(plot);
  list.AddText(font, font->FontSize, {place.x + style.points(2), place.y}, quiet, unit.c_str());
  const float room = width - width_of(unit, style) - style.points(8);
  const std::vector<std::string> labels = LegendLabels(plot, frame, room, !unit.empty()).labels();

  const float middle = place.y + 0.5f * font->FontSize + style.points(1);
  float right = place.x + width;
  for (std::size_t i = labels.size(); i-- > 0;) {
    right -= width_of(labels[i], style);
    if (right < place.x + style.points(24)) break;
    list.AddText(font, font->FontSize, {right, place.y}, quiet, labels[i].c_str());
    right -= style.points(14);
    list.AddRectFilled({right, middle - style.points(1.5f)}, {right + style.points(9), middle + style.points(1.5f)},
                       packed(line_colour(style, i)), style.points(1.5f));
    right -= style.points(10);
  }
}

}  // namespace inkwell::window
