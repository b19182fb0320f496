// Figures of docs/cycles.md for the compiler of the firmware image.
#pragma once

#include <string_view>

namespace inkwell::tests {

/// Fails the test unless the figure of this row, in the column of the firmware's compiler, is within 5 % of `measured`.
/// The test ignores a compiler without a column.
void check_figure_on_cycles_page(std::string_view row, double measured);

}  // namespace inkwell::tests
