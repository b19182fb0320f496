// Which signals are recorded, and how columns are named on the command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <protocol/signals.hpp>
#include <recording/quantity.hpp>

namespace inkwell::recording {

/// What a replay and its plots need: joints, gimbal, position, penetration, force, torques, currents, duties,
/// and whose force it is.
std::vector<protocol::Signal> standard_signals();

/// The whole path of the paper's Figure 7, from the encoders to the duties: as much as the scope carries at once.
std::vector<protocol::Signal> signal_path();

/// Reads names with commas between them. Throws device::Error that names the nearest signal for one that is
/// unknown, and one for more than the scope carries at once.
std::vector<protocol::Signal> parse_signals(std::string_view names);

/// Reads names of signals and of what a simulation knows, with commas between them. Throws device::Error that names the
/// nearest one for one that is unknown.
std::vector<Quantity> parse_quantities(std::string_view names);

}  // namespace inkwell::recording
