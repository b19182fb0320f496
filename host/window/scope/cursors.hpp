// Two cursors of the time plots, between which the scope measures.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <plot/plot.hpp>
#include <scope/timeline.hpp>

namespace inkwell::window {

class Cursors {
 public:
  bool are_shown() const { return are_shown_; }
  void toggle() { are_shown_ = !are_shown_; }

  /// Draws the cursors into a time plot, which is ImGui's last item, and handles their drag.
  void draw(const PlotArea& area, const Style& style);
  /// Moves the first (0) or second (1) cursor by `steps` hundredths of the span.
  void step(std::size_t cursor, int steps);
  /// True while a cursor is dragged; the plot is then not dragged.
  bool is_dragged() const { return dragged_ >= 0; }

  /// Values of a signal at both cursors; NaN where the value is unknown.
  std::array<double, 2> values(const SignalSeries& series, const Stretch& stretch) const;
  /// Distance of the cursors, such as "12.5 ms, 80 Hz".
  std::string distance(double span_s) const;

 private:
  bool are_shown_ = false;
  std::array<double, 2> parts_{-0.66, -0.33};  ///< as a fraction of the span, from the right end
  int dragged_ = -1;
};

}  // namespace inkwell::window
