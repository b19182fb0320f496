#include "host/companion/window/scope/cursors.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace inkwell::window {

void Cursors::draw(const PlotArea& area, const Style& style) {
  if (!are_shown_) return;
  const ImGuiIO& io = ImGui::GetIO();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (int i = 0; i < 2; ++i) {
    double& part = parts_[static_cast<std::size_t>(i)];
    const float x = area.maximum.x + static_cast<float>(part) * area.width();
    const bool near = ImGui::IsItemHovered() && std::abs(io.MousePos.x - x) < style.points(6);
    if (ImGui::IsItemActivated() && near) dragged_ = i;
    if (ImGui::IsItemActive() && dragged_ == i)
      part = std::clamp(static_cast<double>((io.MousePos.x - area.maximum.x) / area.width()), -1.0, 0.0);
    if (near) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    list.AddLine({x, area.minimum.y}, {x, area.maximum.y}, packed(style.palette->text.with_alpha(near ? 255 : 150)),
                 style.points(1));
  }
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) dragged_ = -1;
}

void Cursors::step(std::size_t cursor, int steps) {
  constexpr double step_part = 0.01;
  parts_[cursor] = std::clamp(parts_[cursor] + step_part * steps, -1.0, 0.0);
}

std::array<double, 2> Cursors::values(const SignalSeries& series, const Stretch& stretch) const {
  std::array<double, 2> values{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double index = stretch.last + parts_[i] * stretch.span();
    const bool is_known = index >= static_cast<double>(series.begin()) && index < static_cast<double>(series.end());
    values[i] = is_known ? static_cast<double>(series[static_cast<std::uint64_t>(index)]) : std::nan("");
  }
  return values;
}

std::string Cursors::distance(double span_s) const {
  const double apart_s = std::abs(parts_[1] - parts_[0]) * span_s;
  return fmt::format("{:.5g} ms, {:.4g} Hz", 1000.0 * apart_s, 1.0 / std::max(apart_s, 1e-9));
}

}  // namespace inkwell::window
