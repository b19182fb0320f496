// Two lines across the time plots, between which the scope measures.
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

  /// Draws them into a time plot, whose item is the last one of ImGui's, and moves the one that is dragged.
  void draw(const PlotArea& area, const Style& style);
  /// Moves the first (0) or second (1) by so many hundredths of the span.
  void step(std::size_t cursor, int steps);
  /// One is being dragged, so that the plot itself is not.
  bool is_dragged() const { return dragged_ >= 0; }

  /// What a signal is at each of them; NaN where it is not known.
  std::array<double, 2> values(const SignalSeries& series, const Stretch& stretch) const;
  /// "12.5 ms, 80 Hz": how far apart they are.
  std::string distance(double span_s) const;

 private:
  bool are_shown_ = false;
  std::array<double, 2> parts_{-0.66, -0.33};  ///< of the span, from the right end
  int dragged_ = -1;
};

}  // namespace inkwell::window
