#include "host/companion/window/frame/value_range.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace inkwell::window {

namespace {
constexpr float points_of_whole_range = 1000.0f;
}

float ValueRange::part_of(float value) const {
  const float part =
      logarithmic ? std::log(value / minimum) / std::log(maximum / minimum) : (value - minimum) / (maximum - minimum);
  return std::clamp(part, 0.0f, 1.0f);
}

float ValueRange::dragged(float from, float points) const {
  const float part = points / points_of_whole_range;
  const float value = logarithmic ? from * std::pow(maximum / minimum, part) : from + part * (maximum - minimum);
  const float steps_per_unit = std::pow(10.0f, static_cast<float>(decimals));
  return std::clamp(std::round(value * steps_per_unit) / steps_per_unit, minimum, maximum);
}

std::string ValueRange::text_of(float value) const { return fmt::format("{:.{}f}", value, decimals); }

}  // namespace inkwell::window
