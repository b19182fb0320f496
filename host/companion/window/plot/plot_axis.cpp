#include "host/companion/window/plot/plot_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace inkwell::window {

namespace {

constexpr double shrink_delay_s = 1.5;

double tick_step(double extent, int wanted) {
  const double rough = extent / std::max(wanted, 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  // Selects the nearest of 1, 2, 5 and 10 on a logarithmic scale.
  const double factor = rough / power;
  return power * (factor < std::sqrt(2.0)    ? 1.0
                  : factor < std::sqrt(10.0) ? 2.0
                  : factor < std::sqrt(50.0) ? 5.0
                                             : 10.0);
}

}  // namespace

std::vector<double> ticks(const AxisRange& range, int wanted) {
  std::vector<double> result;
  if (!(range.extent() > 0.0)) return result;
  const double step = tick_step(range.extent(), wanted);
  const double first = std::ceil(range.minimum / step - 1e-9);
  const double last = std::floor(range.maximum / step + 1e-9);
  for (double i = first; i <= last; i += 1.0) result.push_back(i * step + 0.0);
  return result;
}

double extent_around_zero(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 7> extents{
      {{"m", 0.02}, {"rad", 0.2}, {"m/s", 0.2}, {"rad/s", 2.0}, {"N", 2.0}, {"Nm", 0.1}, {"A", 0.2}}};
  const auto found = std::ranges::find(extents, unit, &std::pair<std::string_view, double>::first);
  return found == extents.end() ? 2.0 : found->second;
}

AxisRange enclosing_range(double minimum, double maximum, double around_zero) {
  if (std::isnan(minimum) || std::isnan(maximum)) return {-0.5 * around_zero, 0.5 * around_zero};
  const double middle = 0.5 * (minimum + maximum);
  if (minimum == maximum && middle == 0.0) return {-0.5 * around_zero, 0.5 * around_zero};
  const double least = minimum < maximum ? std::max(1e-4 * std::abs(middle), 1e-9) : 0.2 * std::abs(middle);
  const double extent = std::max(maximum - minimum, least);
  const double step = tick_step(extent, 10);
  const double room = 0.06 * extent;
  return {std::floor((middle - 0.5 * extent - room) / step) * step,
          std::ceil((middle + 0.5 * extent + room) / step) * step};
}

std::string tick_label(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  const double largest = std::max(std::abs(value), step);
  if (largest >= 1e5 || step < 1e-4) return fmt::format("{:.3g}", value);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  return fmt::format("{:.{}f}", value, decimals);
}

AxisRange SteadyRange::update(double minimum, double maximum, double now_s) {
  const AxisRange wanted = enclosing_range(minimum, maximum, around_zero_);
  const bool fits = range_.extent() > 0.0 && wanted.minimum >= range_.minimum && wanted.maximum <= range_.maximum;
  const bool is_much_smaller = wanted.extent() < 0.8 * range_.extent();
  const bool was_guess = std::exchange(is_guess_, !(minimum < maximum));
  if (was_guess && !is_guess_) {
    range_ = wanted;
    small_since_s_ = now_s;
  } else if (!fits) {
    // The range grows immediately.
    range_ = range_.extent() > 0.0
                 ? AxisRange{std::min(wanted.minimum, range_.minimum), std::max(wanted.maximum, range_.maximum)}
                 : wanted;
    if (wanted.extent() < 0.6 * range_.extent()) range_ = wanted;
    small_since_s_ = now_s;
  } else if (!is_much_smaller) {
    small_since_s_ = now_s;
  } else if (now_s - small_since_s_ > shrink_delay_s) {
    range_ = wanted;
  }
  return range_;
}

}  // namespace inkwell::window
