// Two cursors that measure time and value differences in the time plots.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "host/companion/window/plot/plot.hpp"
#include "host/companion/window/scope/timeline.hpp"

namespace inkwell::window {

class Cursors {
 public:
  bool are_shown() const { return are_shown_; }
  void toggle() { are_shown_ = !are_shown_; }

  /// Draws the cursors and handles dragging. The last ImGui item must be the time plot.
  void draw(const PlotArea& area, const Style& style);
  /// Moves the first (0) or second (1) cursor by `steps` percent of the displayed time span.
  void step(std::size_t cursor, int steps);
  /// Returns true while the user drags a cursor. A cursor drag disables plot dragging.
  bool is_dragged() const { return dragged_ >= 0; }

  /// Returns the values of a signal at both cursors; NaN if a value is unknown.
  std::array<double, 2> values(const SignalSeries& series, const Stretch& stretch) const;
  /// Returns the distance between the cursors, such as "12.5 ms, 80 Hz".
  std::string distance(double span_s) const;

 private:
  bool are_shown_ = false;
  std::array<double, 2> parts_{-0.66, -0.33};  ///< distance from the right end, as a negative fraction of the span
  int dragged_ = -1;
};

}  // namespace inkwell::window
