// The line above a pane of the scope: which colour is which signal, and its values at the cursors.
#include "legend.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <scope/scope_pane.hpp>

namespace inkwell::window {

namespace {

// "force_N" -> "force": the unit stands beside the pane's title if all its signals have the same.
std::string short_name(const protocol::SignalInfo& info, bool unit_is_told) {
  std::string ending = fmt::format("_{}", info.unit);
  std::ranges::replace(ending, '/', '_');
  std::string name{info.name};
  if (unit_is_told && !info.unit.empty() && name.ends_with(ending)) name.resize(name.size() - ending.size());
  return name;
}

// "penetration_x" -> "x"
std::string last_word(const std::string& name) { return name.substr(name.rfind('_') + 1); }

}  // namespace

std::string formatted(double value) { return std::isnan(value) ? "—" : fmt::format("{:.4g}", value); }

std::string common_unit(const Pane& pane) {
  std::string_view unit = protocol::info(pane.signals.front()).unit;
  for (protocol::Signal signal : pane.signals)
    if (protocol::info(signal).unit != unit) return "";
  return std::string(unit);
}

Colour line_colour(const Style& style, std::size_t index) {
  return style.palette->lines[index % style.palette->lines.size()];
}

void ScopePane::draw_legend(std::size_t index, ImVec2 place, float width, const Stretch& stretch,
                            const Style& style) const {
  const Pane& pane = layout_.panes[index];
  const Palette& palette = *style.palette;
  ImFont* font = style.fonts.caption;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float right = place.x + width;
  const std::string unit = common_unit(pane);
  list.AddText(font, font->FontSize, {place.x + style.points(2), place.y}, packed(palette.text_quiet), unit.c_str());
  std::vector<std::string> names;
  float wanted = 0.0f;
  for (const protocol::Signal signal : pane.signals) {
    names.push_back(short_name(protocol::info(signal), !unit.empty()));
    wanted += font->CalcTextSizeA(font->FontSize, 1e4f, 0, names.back().c_str()).x + style.points(24);
  }
  // Where the pane is narrow its title tells the rest.
  const float unit_width = font->CalcTextSizeA(font->FontSize, 1e4f, 0, unit.c_str()).x;
  if (wanted > width - unit_width - style.points(8) && names.size() > 1)
    for (std::string& name : names) name = last_word(name);
  const auto with_values = [&](std::size_t i, bool in_full) {
    const SignalSeries* series = history_.find(pane.signals[i]);
    if (series == nullptr) return names[i];
    const auto at = [&](double cursor) {
      const double index_at = stretch.last + cursor * stretch.span();
      return index_at < static_cast<double>(series->begin()) || index_at >= static_cast<double>(series->end())
                 ? std::nan("")
                 : static_cast<double>((*series)[static_cast<std::uint64_t>(index_at)]);
    };
    const std::string difference = formatted(at(cursors_[1]) - at(cursors_[0]));
    return in_full ? fmt::format("{}  {}  {}  diff. {}", names[i], formatted(at(cursors_[0])),
                                 formatted(at(cursors_[1])), difference)
                   : fmt::format("Δ{}  {}", last_word(names[i]), difference);
  };
  // With cursors, as much of their values as there is room for: both and the difference, that alone, or nothing.
  std::vector<std::string> labels = names;
  if (cursors_are_shown_ && pane.kind == PaneKind::time) {
    for (const bool in_full : {true, false}) {
      std::vector<std::string> longer;
      float taken = 0.0f;
      for (std::size_t i = 0; i < names.size(); ++i) {
        longer.push_back(with_values(i, in_full));
        taken += font->CalcTextSizeA(font->FontSize, 1e4f, 0, longer.back().c_str()).x + style.points(24);
      }
      if (taken > width - unit_width - style.points(8)) continue;
      labels = std::move(longer);
      break;
    }
  }
  for (std::size_t i = pane.signals.size(); i-- > 0;) {
    const std::string& label = labels[i];
    const float taken = font->CalcTextSizeA(font->FontSize, 1e4f, 0, label.c_str()).x;
    right -= taken;
    if (right < place.x + style.points(24)) break;
    list.AddText(font, font->FontSize, {right, place.y}, packed(palette.text_quiet), label.c_str());
    right -= style.points(14);
    const float middle = place.y + 0.5f * font->FontSize + style.points(1);
    list.AddRectFilled({right, middle - style.points(1.5f)}, {right + style.points(9), middle + style.points(1.5f)},
                       packed(line_colour(style, i)), style.points(1.5f));
    right -= style.points(10);
  }
}

}  // namespace inkwell::window
