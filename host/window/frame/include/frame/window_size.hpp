// How big the window is opened.
#pragma once

#include <optional>

namespace inkwell::window {

struct ScreenSize {
  int width, height;
  bool operator==(const ScreenSize&) const = default;
};

/// Nothing overlaps in a window as big as this or bigger. In points: pixels of a display of 96 dots per inch.
inline constexpr ScreenSize smallest_window_points{900, 560};

/// `scale`, or what is left of it, but no less than 1, where the display has no room for the smallest window at that.
float fitting_scale(float scale, std::optional<ScreenSize> room);

/// In pixels, of a window that is so many points big: as big as its text. `room`: what the display has, if it tells.
ScreenSize window_size(ScreenSize points, float scale, std::optional<ScreenSize> room);

}  // namespace inkwell::window
