// Texts of the statistics of a signal.
#pragma once

#include <string>
#include <vector>

#include "host/companion/window/frame/shown_unit.hpp"
#include "host/companion/window/scope/analysis.hpp"

namespace inkwell::window {

/// Returns a number with four digits, or a dash for NaN.
std::string formatted(double value);

/// Returns texts with the unit for wide and narrow plots, longest first.
std::vector<std::string> statistics_lines(const Statistics& statistics, const ShownUnit& unit);

}  // namespace inkwell::window
