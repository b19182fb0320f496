#include "host/companion/window/frame/window_size.hpp"

#include <algorithm>
#include <cmath>

namespace inkwell::window {

DisplayScale display_scale(float content_scale, bool has_pixel_units) {
  const float scale = std::clamp(content_scale, 1.0f, 4.0f);
  return {.pixels_per_point = scale, .pixels_per_unit = has_pixel_units ? 1.0f : scale};
}

float pixels_per_unit(int width_units, int width_pixels, bool has_pixel_units) {
  if (has_pixel_units || width_units <= 0 || width_pixels <= 0) return 1.0f;
  return static_cast<float>(width_pixels) / static_cast<float>(width_units);
}

WindowFit fit_window(ScreenSize points, const DisplayScale& display, float pixels_per_point,
                     std::optional<ScreenSize> room_pixels) {
  const auto units = [&](int pixels) {
    return static_cast<int>(std::lround(static_cast<float>(pixels) / display.pixels_per_unit));
  };
  std::optional<ScreenSize> room;
  if (room_pixels) room = {units(room_pixels->width), units(room_pixels->height)};
  const float wanted = pixels_per_point > 0.0f ? pixels_per_point : display.pixels_per_point;
  const float scale = fitting_scale(wanted / display.pixels_per_unit, room);
  return {window_size(points, scale, room), window_size(smallest_window_points, scale, room), scale};
}

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
