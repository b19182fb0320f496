// Continued use of the arm after an undetected fault.
#pragma once

#include "host/lab/campaign/board_run.hpp"
#include "host/lab/campaign/result.hpp"

namespace inkwell::campaign {

/// Continues the situation for a while, presses the arm into the forward and the side wall, then swings it. Stops when
/// the force switches off. Fills in the members about use, unless the device disconnects without a restart.
void use_on(BoardRun& board, const protocol::ParameterSet& parameters, Result& result);

}  // namespace inkwell::campaign
