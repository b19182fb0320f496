// The quantity in a column of a recording: a signal from the device or a simulated quantity.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "protocol/signals.hpp"
#include "protocol/simulation.hpp"

namespace inkwell::recording {

using Quantity = std::variant<protocol::Signal, protocol::SimulatedQuantity>;

std::string_view name_of(Quantity quantity);
std::string_view unit_of(Quantity quantity);

/// Description without axis and unit: "position" for position_x_m, "current reference" for current_reference_1_A.
std::string words_of(Quantity quantity);

}  // namespace inkwell::recording
