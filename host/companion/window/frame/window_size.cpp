#include "host/companion/window/frame/window_size.hpp"

#include <algorithm>
#include <cmath>

namespace inkwell::window {

float fitting_scale(float scale, std::optional<ScreenSize> room) {
  if (!room) return scale;
  const auto fits = [](int length, int points) { return static_cast<float>(length) / static_cast<float>(points); };
  const float largest =
      std::min(fits(room->width, smallest_window_points.width), fits(room->height, smallest_window_points.height));
  return std::min(scale, std::max(1.0f, largest));
}

ScreenSize window_size(ScreenSize points, float scale, std::optional<ScreenSize> room) {
  const auto scaled = [scale](int length) { return static_cast<int>(std::lround(static_cast<float>(length) * scale)); };
  const ScreenSize wanted{scaled(points.width), scaled(points.height)};
  if (!room) return wanted;
  return {std::min(wanted.width, room->width), std::min(wanted.height, room->height)};
}

}  // namespace inkwell::window
