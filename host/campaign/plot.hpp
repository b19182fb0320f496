// A small histogram as SVG.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace inkwell::campaign {

struct Bar {
  std::string label = {};  ///< below it; empty where edges are named instead
  unsigned count = 0;
  unsigned quiet = 0;  ///< so many of them in the quiet colour, at the foot
};

/// A line across the bars that the eye shall measure them by.
struct Limit {
  double bars;  ///< so many of them lie to its left
  std::string text;
};

struct Histogram {
  std::string title, axis;  ///< what is counted; what it is counted by, with its unit
  std::vector<Bar> bars;
  std::vector<std::string> edges = {};  ///< one more than bars, if these are classes of a number
  bool last_apart = false;              ///< the last bar is no class of the axis
  std::optional<Limit> limit = {};
  std::string strong_means, quiet_means;  ///< what a colour says; empty: it is not there
};

std::string svg_of(const Histogram& histogram);

}  // namespace inkwell::campaign
