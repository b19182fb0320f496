#include "plot.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace inkwell::campaign {

std::string histogram_svg(std::string_view title, std::span<const Bar> bars) {
  constexpr int bar_width = 64, gap = 8, height = 120, above = 44, below = 26, left = 12;
  unsigned highest = 1;
  for (const Bar& bar : bars) highest = std::max(highest, bar.count);
  const int width = 2 * left + static_cast<int>(bars.size()) * (bar_width + gap) - gap;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<text x=\"{2}\" y=\"20\" font-size=\"13\" font-weight=\"bold\">{3}</text>\n",
      width, above + height + below, left, title);
  int x = left;
  for (const Bar& bar : bars) {
    const int tall = static_cast<int>(static_cast<unsigned>(height) * bar.count / highest);
    const int top = above + height - tall, middle = x + bar_width / 2;
    svg +=
        fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#3b6ea5\"/>\n", x, top, bar_width, tall);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", middle, top - 4, bar.count);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", middle, above + height + 17,
                       bar.label);
    x += bar_width + gap;
  }
  return svg + "</svg>\n";
}

}  // namespace inkwell::campaign
