// Initial size of the window.
#pragma once

#include <optional>

namespace inkwell::window {

struct ScreenSize {
  int width, height;
  bool operator==(const ScreenSize&) const = default;
};

/// Smallest size without overlapping panes. A point is 1/96 inch.
inline constexpr ScreenSize smallest_window_points{900, 560};

/// Returns a reduced scale if the display is too small for the smallest window, and otherwise `scale`. A reduced scale
/// is at least 1.
float fitting_scale(float scale, std::optional<ScreenSize> room);

/// Converts a window size from points to pixels. `room` is the usable area of the display.
ScreenSize window_size(ScreenSize points, float scale, std::optional<ScreenSize> room);

}  // namespace inkwell::window
