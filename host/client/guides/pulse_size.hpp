// Limit of a guide's test pulses, below the limits of motor and board.
#pragma once

#include "protocol/parameters.hpp"

namespace inkwell::guides {

/// Returns the current limit in A for a pulse of motor 1 to 3 near the inkwell. The result is slightly below the
/// board's limit from force_limit_N (test_pulse.hpp). Throws device::Error if the limit is too small for a measurement.
float allowed_pulse_A(const protocol::ParameterSet& set, int motor);

}  // namespace inkwell::guides
