// Checks the figures of docs/cycles.md for the compiler of the firmware image.
#pragma once

#include <string_view>

namespace inkwell::tests {

/// Fails the test unless the page's figure is within 5 % of `measured`. `row` selects the row, and the firmware's
/// compiler selects the column. Accepts any value if the page has no column for the compiler.
void check_figure_on_cycles_page(std::string_view row, double measured);

}  // namespace inkwell::tests
