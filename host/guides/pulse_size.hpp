// How large a guide's test pulses may be: below what motor and board allow.
#pragma once

#include <protocol/parameters.hpp>

namespace inkwell::guides {

/// Of a pulse of motor 1 to 3 near the inkwell, in A: a little less than the board gives it by force_limit_N
/// (control/test_pulse.hpp). Throws device::Error where that is too little to measure by.
float allowed_pulse_A(const protocol::ParameterSet& set, int motor);

}  // namespace inkwell::guides
