// A small histogram as SVG.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace inkwell::campaign {

struct Bar {
  std::string label;
  unsigned count;
};

std::string histogram_svg(std::string_view title, std::span<const Bar> bars);

}  // namespace inkwell::campaign
