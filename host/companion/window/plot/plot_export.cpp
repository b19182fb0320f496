#include "host/companion/window/plot/plot_export.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace inkwell::window {

namespace {

constexpr double width = 800, height = 400, left = 70, right = 20, top = 40, bottom = 45;

std::string color_of(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char character : text) {
    switch (character) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      default: result += character;
    }
  }
  return result;
}

double x_of(const PlotTable& table, double value) { return left + table.x_range.part(value) * (width - left - right); }
double y_of(const PlotTable& table, double value) {
  return height - bottom - table.y_range.part(value) * (height - top - bottom);
}

void add_text(std::string& svg, double x, double y, std::string_view anchor, Colour colour, std::string_view text) {
  fmt::format_to(std::back_inserter(svg), "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n",
                 x, y, anchor, color_of(colour), escaped(text));
}

void add_axes(std::string& svg, const PlotTable& table, const Palette& palette) {
  const auto line = [&](double x1, double y1, double x2, double y2) {
    fmt::format_to(std::back_inserter(svg),
                   "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2, y2,
                   color_of(palette.line));
  };
  const auto x_ticks = ticks(table.x_range, 8), y_ticks = ticks(table.y_range, 6);
  const auto step = [](const std::vector<double>& values, const AxisRange& range) {
    return values.size() > 1 ? values[1] - values[0] : range.extent();
  };
  for (const double value : x_ticks) {
    line(x_of(table, value), top, x_of(table, value), height - bottom);
    add_text(svg, x_of(table, value), height - bottom + 16, "middle", palette.text_quiet,
             tick_label(value, step(x_ticks, table.x_range)));
  }
  for (const double value : y_ticks) {
    line(left, y_of(table, value), width - right, y_of(table, value));
    add_text(svg, left - 6, y_of(table, value) + 4, "end", palette.text_quiet,
             tick_label(value, step(y_ticks, table.y_range)));
  }
  add_text(svg, width - right, height - 8, "end", palette.text_quiet, table.x_name);
}

void add_legend(std::string& svg, const PlotTable& table, const Palette& palette) {
  add_text(svg, left, 24, "start", palette.text, table.title);
  double x = width - right;
  for (std::size_t i = table.names.size(); i-- > 0;) {
    add_text(svg, x, 24, "end", palette.lines[i % palette.lines.size()], table.names[i]);
    x -= 8.0 * static_cast<double>(table.names[i].size()) + 16.0;
  }
}

/// Collects the points of a line. A lost sample starts a new line.
class Lines {
 public:
  void add(double x, double y) { fmt::format_to(std::back_inserter(points_), "{:.2f},{:.2f} ", x, y); }
  void end(std::string& svg, Colour colour) {
    if (!points_.empty())
      fmt::format_to(std::back_inserter(svg),
                     "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" points=\"{}\"/>\n", color_of(colour),
                     points_);
    points_.clear();
  }

 private:
  std::string points_;
};

void add_line(std::string& svg, const PlotTable& table, const std::vector<float>& values, Colour colour) {
  Lines lines;
  for (std::size_t i = 0; i < table.x.size();) {
    if (std::isnan(values[i])) {
      lines.end(svg, colour);
      ++i;
      continue;
    }
    const double x = x_of(table, table.x[i]);
    double least = static_cast<double>(values[i]), most = least;
    lines.add(x, y_of(table, least));
    // Joins the samples of a column of pixels.
    std::size_t next = i + 1;
    for (; table.x_increases && next < table.x.size() && !std::isnan(values[next]) &&
           x_of(table, table.x[next]) < x + 0.5;
         ++next) {
      least = std::min(least, static_cast<double>(values[next]));
      most = std::max(most, static_cast<double>(values[next]));
    }
    if (next > i + 1) {
      lines.add(x, y_of(table, least));
      lines.add(x, y_of(table, most));
    }
    i = next;
  }
  lines.end(svg, colour);
}

}  // namespace

PlotTable table_of(const std::vector<NamedPoints>& lines, const AxisRange& x_range) {
  constexpr double step = 1e-6;  // equal x of several lines may differ by rounding errors
  std::map<long long, std::size_t> rows;
  for (const NamedPoints& line : lines)
    for (const auto& [x, y] : line.points)
      if (x >= x_range.minimum && x <= x_range.maximum) rows.emplace(std::llround(x / step), 0);
  PlotTable table;
  table.x_range = x_range;
  for (auto& [key, row] : rows) {
    row = table.x.size();
    table.x.push_back(static_cast<double>(key) * step);
  }
  for (const NamedPoints& line : lines) {
    std::string& name = table.names.emplace_back();
    for (const char character : line.name) {
      const bool is_part = std::isalnum(static_cast<unsigned char>(character)) != 0;
      if (is_part || (!name.empty() && name.back() != '_')) name += is_part ? character : '_';
    }
    auto& column = table.columns.emplace_back(table.x.size(), std::nanf(""));
    for (const auto& [x, y] : line.points)
      if (const auto found = rows.find(std::llround(x / step)); found != rows.end())
        column[found->second] = static_cast<float>(y);
  }
  return table;
}

std::string csv_of(const PlotTable& table) {
  std::string csv = table.x_name;
  for (const std::string& name : table.names) csv += "," + name;
  csv += "\n";
  for (std::size_t i = 0; i < table.x.size(); ++i) {
    fmt::format_to(std::back_inserter(csv), "{:.9g}", table.x[i]);
    for (const std::vector<float>& column : table.columns)
      if (std::isnan(column[i]))
        csv += ",";
      else
        fmt::format_to(std::back_inserter(csv), ",{:.9g}", column[i]);
    csv += "\n";
  }
  return csv;
}

std::string svg_of(const PlotTable& table, const Palette& palette) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"Inter, DejaVu Sans, sans-serif\" font-size=\"12\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n"
      "<clipPath id=\"plot\"><rect x=\"{2}\" y=\"{3}\" width=\"{4}\" height=\"{5}\"/></clipPath>\n",
      width, height, left, top, width - left - right, height - top - bottom);
  add_axes(svg, table, palette);
  add_legend(svg, table, palette);
  svg += "<g clip-path=\"url(#plot)\">\n";
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    add_line(svg, table, table.columns[i], palette.lines[i % palette.lines.size()]);
  svg += "</g>\n</svg>\n";
  return svg;
}

std::string write_file(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  return stream ? std::string()
                : fmt::format("{} cannot be written. Check that the folder is writable and that the disk is not full.",
                              file.string());
}

}  // namespace inkwell::window
