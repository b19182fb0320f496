// Initial size of the window.
#pragma once

#include <optional>

namespace inkwell::window {

struct ScreenSize {
  int width, height;
  bool operator==(const ScreenSize&) const = default;
};

/// Smallest size at which nothing overlaps. Points are pixels of a display with 96 dots per inch.
inline constexpr ScreenSize smallest_window_points{900, 560};

/// `scale`, or the largest scale, at least 1, at which the smallest window fits on the display.
float fitting_scale(float scale, std::optional<ScreenSize> room);

/// Size in pixels of a window with this size in points. `room`: usable area of the display, if known.
ScreenSize window_size(ScreenSize points, float scale, std::optional<ScreenSize> room);

}  // namespace inkwell::window
