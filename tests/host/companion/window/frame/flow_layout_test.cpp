#include <vector>

#include <doctest/doctest.h>

#include "host/companion/window/frame/flow_layout.hpp"

using namespace inkwell::window;

TEST_CASE("items are in one row if they fit, and otherwise wrap into complete rows") {
  const std::vector<float> widths{200, 100, 100, 100};
  for (const FlowPosition& position : flow(widths, 530, 900, 10)) CHECK(position.row == 0);
  CHECK(flow(widths, 530, 900, 10).back().x == 430);

  const auto two_rows = flow(widths, 529, 900, 10);
  CHECK(two_rows[0].row == 0);
  for (std::size_t i = 1; i < 4; ++i) CHECK(two_rows[i].row == 1);
  CHECK(two_rows[1].x == 0);

  const auto narrow = flow(widths, 150, 220, 10);
  CHECK(narrow[0].row == 1);  // does not fit in the first row
  CHECK(narrow[1].row == 2);
  CHECK(narrow[2].row == 2);
  CHECK(narrow[3].row == 3);
  CHECK(flow({}, 100, 100, 10).empty());
}
