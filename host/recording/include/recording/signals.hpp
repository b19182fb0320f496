// Which signals are recorded, and how they are named on the command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <protocol/signals.hpp>

namespace inkwell::recording {

/// What a replay and its plots need: joints, gimbal, position, penetration, force, torques, currents and duties.
std::vector<protocol::Signal> standard_signals();

/// The whole path of the paper's Figure 7, from the encoders to the duties: as much as the scope carries at once.
std::vector<protocol::Signal> signal_path();

/// Reads names with commas between them. Throws device::Error that names the nearest signal for one that is
/// unknown, and one for more than the scope carries at once.
std::vector<protocol::Signal> parse_signals(std::string_view names);

/// The quantity that a signal belongs to, in words: "position" for position_x_m, "current reference" for
/// current_reference_1_A.
std::string quantity_of(protocol::Signal signal);

}  // namespace inkwell::recording
