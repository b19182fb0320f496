// A small histogram as SVG.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace inkwell::campaign {

struct Bar {
  std::string label = {};  ///< below the bar; empty if the edges are labeled instead
  unsigned count = 0;
  unsigned quiet = 0;  ///< part of the count in the muted color, at the bottom
};

/// A reference line across the bars.
struct Limit {
  double bars;  ///< number of bars to the left of the line
  std::string text;
};

struct Histogram {
  std::string title, axis;  ///< counted items; axis quantity with its unit
  std::vector<Bar> bars;
  std::vector<std::string> edges = {};  ///< one more than bars, for numeric classes
  bool last_apart = false;              ///< the last bar is not a class of the axis
  std::optional<Limit> limit = {};
  std::string strong_means, quiet_means;  ///< legend of each color; empty if the color is not used
};

std::string svg_of(const Histogram& histogram);

}  // namespace inkwell::campaign
