// Continued use of the arm after an undetected fault.
#pragma once

#include "host/lab/campaign/board_run.hpp"
#include "host/lab/campaign/result.hpp"

namespace inkwell::campaign {

/// Continues the use of the arm (campaign/run.hpp). Stops when the force switches off. Fills in the members of `result`
/// about continued use.
void use_on(BoardRun& board, const protocol::ParameterSet& parameters, Result& result);

}  // namespace inkwell::campaign
