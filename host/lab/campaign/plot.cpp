#include "host/lab/campaign/plot.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

namespace inkwell::campaign {
namespace {

constexpr int bar_width = 72, height = 140, left = 44, right = 16, above = 66;
constexpr int base = above + height;
constexpr std::string_view strong = "#3b6ea5", quiet = "#b9c1ca", limit_colour = "#b03a2e", ink = "#333333";

struct Text {
  int x, y;
  std::string_view anchor = "middle";
  std::string_view more = {};  ///< attributes
};

std::string text(const Text& at, std::string_view words) {
  return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\"{}{}>{}</text>\n", at.x, at.y, at.anchor,
                     at.more.empty() ? "" : " ", at.more, words);
}

std::string box(int x, int y, int width, int tall, std::string_view colour) {
  if (tall == 0) return {};
  return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", x, y, width, tall, colour);
}

std::string line(int x1, int y1, int x2, int y2, std::string_view more) {
  return fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", x1, y1, x2, y2, more);
}

/// Positions of the bars. Bars of numeric classes nearly touch. If `last_apart` is set, a gap precedes the last bar.
class Layout {
 public:
  explicit Layout(const Histogram& histogram) : histogram_(histogram), gap_(histogram.edges.empty() ? 8 : 2) {}

  int left_of(std::size_t bar) const {
    const bool is_apart = histogram_.last_apart && bar + 1 >= histogram_.bars.size();
    return left + gap_ + static_cast<int>(bar) * (bar_width + gap_) + (is_apart ? apart : 0);
  }
  int middle_of(std::size_t bar) const { return left_of(bar) + bar_width / 2; }
  int end() const { return left_of(histogram_.bars.size() - 1) + bar_width + gap_; }
  /// Right edge of the numeric classes.
  int axis_end() const {
    return histogram_.last_apart ? left_of(histogram_.bars.size() - 2) + bar_width + gap_ : end();
  }
  int edge(double bars) const { return left + gap_ / 2 + static_cast<int>(bars * (bar_width + gap_) + 0.5); }

 private:
  static constexpr int apart = 24;
  const Histogram& histogram_;
  int gap_;
};

/// Letter widths of a wide sans-serif font.
constexpr std::size_t title_letter = 8, letter = 7;

/// Places the number above the bar, or next to the limit line to avoid an overlap.
std::string number_of(const Histogram& histogram, const Layout& layout, std::size_t bar, int y) {
  const std::string digits = std::to_string(histogram.bars[bar].count);
  const int half_width = static_cast<int>(letter * digits.size()) / 2 + 4;
  const int middle = layout.middle_of(bar);
  const int line = histogram.limit ? layout.edge(histogram.limit->bars) : middle + bar_width;
  const int aside = std::abs(line - middle) >= half_width ? 0 : line - middle + (line < middle ? 1 : -1) * half_width;
  return text({middle + aside, y, "middle", "paint-order=\"stroke\" stroke=\"white\" stroke-width=\"4\""}, digits);
}

std::string bars_of(const Histogram& histogram, const Layout& layout) {
  unsigned highest = 1;
  for (const Bar& bar : histogram.bars) highest = std::max(highest, bar.count);
  // Every nonzero bar has a visible height.
  const auto tall = [&](unsigned count) {
    return count == 0 ? 0 : std::max(1, static_cast<int>(static_cast<unsigned>(height) * count / highest));
  };
  std::string svg;
  for (std::size_t i = 0; i < histogram.bars.size(); ++i) {
    const Bar& bar = histogram.bars[i];
    const int whole = tall(bar.count), foot = std::min(whole, tall(bar.quiet));
    svg += box(layout.left_of(i), base - whole, bar_width, whole - foot, strong);
    svg += box(layout.left_of(i), base - foot, bar_width, foot, quiet);
    if (bar.count > 0) svg += number_of(histogram, layout, i, base - whole - 5);
    if (!bar.label.empty()) svg += text({layout.middle_of(i), base + 17}, bar.label);
  }
  return svg;
}

std::string axis_of(const Histogram& histogram, const Layout& layout) {
  const std::string stroke = fmt::format("stroke=\"{}\"", ink);
  std::string svg = line(left, base, layout.end(), base, stroke);
  for (std::size_t i = 0; i < histogram.edges.size(); ++i) {
    const int x = layout.edge(static_cast<double>(i));
    svg += line(x, base, x, base + 4, stroke) + text({x, base + 17}, histogram.edges[i]);
  }
  svg += text({(left + layout.axis_end()) / 2, base + 38}, histogram.axis);
  return svg + text({0, 0, "middle",
                     fmt::format("transform=\"translate({},{}) rotate(-90)\"", left - 14, above + height / 2)},
                    "cases");
}

constexpr int key_indent = 18, key_line = 18;

/// Right edge of the title and the legend.
int end_of_texts(const Histogram& histogram) {
  const std::size_t longest = std::max(histogram.strong_means.size(), histogram.quiet_means.size());
  return left + static_cast<int>(std::max(title_letter * histogram.title.size(), key_indent + letter * longest));
}

int end_of_drawing(const Histogram& histogram, const Layout& layout) {
  return std::max(layout.end(), end_of_texts(histogram));
}

std::string limit_of(const Histogram& histogram, const Layout& layout) {
  if (!histogram.limit) return {};
  const int x = layout.edge(histogram.limit->bars);
  const int reach = x + 6 + static_cast<int>(letter * histogram.limit->text.size());
  const bool has_room = reach <= end_of_drawing(histogram, layout);
  return line(x, above - 32, x, base, fmt::format("stroke=\"{}\" stroke-dasharray=\"5 3\"", limit_colour)) +
         // The text is above the number on the highest bar.
         text({x + (has_room ? 6 : -6), above - 23, has_room ? "start" : "end",
               fmt::format("fill=\"{}\"", limit_colour)},
              histogram.limit->text);
}

std::string key_of(const Histogram& histogram) {
  std::string svg;
  int y = base + 64;
  const auto entry = [&](std::string_view colour, const std::string& meaning) {
    if (meaning.empty()) return;
    svg += box(left, y - 10, 12, 12, colour) + text({left + key_indent, y, "start"}, meaning);
    y += key_line;
  };
  entry(strong, histogram.strong_means);
  entry(quiet, histogram.quiet_means);
  return svg;
}

}  // namespace

std::string svg_of(const Histogram& histogram) {
  const Layout layout(histogram);
  const int entries = !histogram.strong_means.empty() + !histogram.quiet_means.empty();
  const int width = end_of_drawing(histogram, layout) + right, tall = base + 50 + key_line * entries + 6;
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
             "font-family=\"sans-serif\" font-size=\"12\" fill=\"{2}\">\n"
             "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
             width, tall, ink) +
         text({left, 22, "start", "font-size=\"13\" font-weight=\"bold\""}, histogram.title) +
         limit_of(histogram, layout) + bars_of(histogram, layout) + axis_of(histogram, layout) + key_of(histogram) +
         "</svg>\n";
}

}  // namespace inkwell::campaign
