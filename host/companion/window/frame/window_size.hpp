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

/// Scales of a display. On X11, a screen unit is a pixel. On Wayland, the desktop scales screen units.
struct DisplayScale {
  float pixels_per_point = 1.0f;
  float pixels_per_unit = 1.0f;
};

/// `content_scale` is the scale that the desktop reports, such as 2 for 192 dots per inch.
DisplayScale display_scale(float content_scale, bool has_pixel_units);

/// Returns the pixels per screen unit of a window with the width `width_units`. On X11, the two widths differ if the
/// window is resized between the two queries.
float pixels_per_unit(int width_units, int width_pixels, bool has_pixel_units);

/// Initial size and scale of the window, in screen units.
struct WindowFit {
  ScreenSize size, smallest;
  float units_per_point;
};

/// Fits a window of `points` into the display. `pixels_per_point` is the scale that the user selects, or 0 for the
/// scale of the display. `room_pixels` is the usable area of the display; empty if it is unknown.
WindowFit fit_window(ScreenSize points, const DisplayScale& display, float pixels_per_point,
                     std::optional<ScreenSize> room_pixels);

/// Returns a reduced scale if the display is too small for the smallest window, and otherwise `scale`. A reduced scale
/// is at least 1.
float fitting_scale(float scale, std::optional<ScreenSize> room);

/// Converts a window size from points to screen units. `room` is the usable area of the display.
ScreenSize window_size(ScreenSize points, float scale, std::optional<ScreenSize> room);

}  // namespace inkwell::window
