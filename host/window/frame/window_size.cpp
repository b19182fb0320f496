#include <frame/window_size.hpp>

#include <algorithm>
#include <cmath>

namespace inkwell::window {

ScreenSize window_size(ScreenSize points, float scale, std::optional<ScreenSize> room) {
  const auto scaled = [scale](int length) { return static_cast<int>(std::lround(static_cast<float>(length) * scale)); };
  const ScreenSize wanted{scaled(points.width), scaled(points.height)};
  if (!room) return wanted;
  return {std::min(wanted.width, room->width), std::min(wanted.height, room->height)};
}

}  // namespace inkwell::window
