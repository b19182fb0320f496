// Wrong local models of a program.
#pragma once

#include "host/lab/campaign/board_run.hpp"
#include "host/lab/campaign/cases.hpp"

namespace inkwell::campaign {

/// Advances board time by `duration_s`. In the first third the program sends a correct floor 1 mm above the tip; then
/// its models are wrong (Deed). Without a pose, the program sends nothing.
void run_with_models(BoardRun& board, Deed deed, double duration_s);

}  // namespace inkwell::campaign
