// Texts about parameters with the labels and units of the window.
#pragma once

#include <string>
#include <string_view>

#include "protocol/parameters.hpp"

namespace inkwell::window {

/// Returns the range of a parameter, such as "0 to 3000 N/m" or "-300 to 300 mm".
std::string range_text(const protocol::ParameterInfo& info);

/// Converts a refusal of the device to the labels and units of the window. "The device refused box_minimum_x_m = 0.2:"
/// becomes "The device refused Box minimum x = 200 mm:". Other texts remain unchanged.
std::string refusal_text(std::string_view refusal);

}  // namespace inkwell::window
