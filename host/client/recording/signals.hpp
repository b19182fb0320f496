// Sets of recorded signals, and the parser for signal names on the command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/client/recording/quantity.hpp"
#include "protocol/signals.hpp"

namespace inkwell::recording {

/// Signals for a replay and its plots: joints, gimbal, position, penetration, force, torques, currents, duties and
/// force source.
std::vector<protocol::Signal> standard_signals();

/// The complete path of the paper's Figure 7, from the encoders to the duties.
std::vector<protocol::Signal> signal_path();

/// All signals of the table and of the known force law.
std::vector<protocol::Signal> all_signals();

/// Parses comma-separated names. For an unknown name, throws device::Error with the nearest signal.
std::vector<protocol::Signal> parse_signals(std::string_view names);

/// Parses comma-separated names of signals and simulated quantities. For an unknown name, throws device::Error with the
/// nearest name.
std::vector<Quantity> parse_quantities(std::string_view names);

}  // namespace inkwell::recording
