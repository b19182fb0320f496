// How the scope writes numbers and tells its signals apart.
#pragma once

#include <string>

#include <frame/style.hpp>
#include <scope/scope_layout.hpp>

namespace inkwell::window {

/// Four digits; a dash where there is no value (NaN).
std::string formatted(double value);

/// Signals of one pane usually share a unit, which then stands once at the axis; else empty.
std::string common_unit(const Pane& pane);

Colour line_colour(const Style& style, std::size_t index);

}  // namespace inkwell::window
