#include "tests/system/cycles_page.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/system/firmware_image.hpp"

namespace inkwell::tests {
namespace {

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (line.remove_prefix(1); !line.empty();) {
    const auto end = std::min(line.find('|'), line.size());
    std::string_view cell = line.substr(0, end);
    while (cell.starts_with(' ')) cell.remove_prefix(1);
    while (cell.ends_with(' ')) cell.remove_suffix(1);
    cells.emplace_back(cell);
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return cells;
}

}  // namespace

void check_figure_on_cycles_page(std::string_view row, double measured) {
  std::ifstream page(INKWELL_SOURCE_DIRECTORY "/docs/cycles.md");
  const std::string compiler = "GCC " + firmware_compiler_version();
  std::vector<std::string> compilers;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| ")) continue;
    const auto cells = cells_of(line);
    if (cells[0] == "figure, in cycles") compilers = cells;
    if (cells[0] != row || compilers.empty()) continue;
    const auto column = std::ranges::find(compilers, compiler) - compilers.begin();
    if (column == std::ssize(compilers)) {
      MESSAGE("docs/cycles.md has no figures of ", compiler);
      return;
    }
    INFO("docs/cycles.md, ", std::string(row), ", ", compiler, ": measured ", measured);
    CHECK(std::stod(cells.at(static_cast<std::size_t>(column))) == doctest::Approx(measured).epsilon(0.05));
    return;
  }
  FAIL("docs/cycles.md has no row \"", std::string(row), "\"");
}

}  // namespace inkwell::tests
