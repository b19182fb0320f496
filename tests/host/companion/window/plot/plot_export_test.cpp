// Tests the files of plots.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "host/companion/window/plot/plot_export.hpp"

using namespace inkwell::window;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

PlotTable table_of(std::size_t samples) {
  PlotTable table{"Force <x & y>", "time_s", {}, {"force_x_N", "force_y_N"}, {{}, {}}};
  for (std::size_t i = 0; i < samples; ++i) {
    table.x.push_back(static_cast<double>(i) / static_cast<double>(samples));
    table.columns[0].push_back(0.25f);
    table.columns[1].push_back(i == samples / 2 ? std::nanf("") : 0.5f);
  }
  return table;
}

}  // namespace

TEST_CASE("lines with points at different times become columns of one table") {
  const auto table = table_of({{"motor 1, before A", {{-1.0, 5.0}, {0.05, 1.0}, {0.1, 2.0}}},
                               {"motor 2, after A", {{0.1 + 1e-12, 3.0}, {0.15, 4.0}, {9.0, 7.0}}}},
                              {-0.5, 1.0});
  CHECK(table.names == std::vector<std::string>{"motor_1_before_A", "motor_2_after_A"});
  REQUIRE(table.x.size() == 3);
  CHECK(table.x[1] == doctest::Approx(0.1));
  CHECK(table.columns[0][1] == 2.0f);
  CHECK(table.columns[1][1] == 3.0f);
  CHECK(std::isnan(table.columns[0][2]));
  CHECK(std::isnan(table.columns[1][0]));
  CHECK(table.columns[1][2] == 4.0f);
}

TEST_CASE("the CSV file of a plot has the names, and an empty field for a lost sample") {
  CHECK(csv_of(table_of(4)) == "time_s,force_x_N,force_y_N\n0,0.25,0.5\n0.25,0.25,0.5\n0.5,0.25,\n0.75,0.25,0.5\n");
}

TEST_CASE("the SVG file of a plot has a line per signal, a gap for a lost sample, and escaped names") {
  const std::string svg = svg_of(table_of(4), light_palette);
  CHECK(count(svg, "<polyline") == 3);
  CHECK(svg.find("Force &lt;x &amp; y&gt;") != std::string::npos);
  CHECK(svg.find("force_x_N") != std::string::npos);
  CHECK(svg.ends_with("</svg>\n"));
}

TEST_CASE("the size of an SVG file depends on its width, not on the number of samples, and a spike remains visible") {
  PlotTable table = table_of(400'000);
  table.columns[0][123'456] = 1.0f;
  const std::string svg = svg_of(table, light_palette);
  CHECK(svg.size() < 300'000);
  CHECK(svg.find(",40.00 ") != std::string::npos);  // the spike reaches the upper end of the plot
}
