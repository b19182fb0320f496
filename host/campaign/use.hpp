// What becomes of a fault that was not noticed while the arm was left as it was: the hand goes on to use the arm.
#pragma once

#include <campaign/board_run.hpp>
#include <campaign/result.hpp>

namespace inkwell::campaign {

/// Goes on as before for a while, presses the arm into the walls in front of it and to its side, then swings it, until
/// the force goes off. Fills in what the result says about use: nothing, if the device goes away without a restart.
void use_on(BoardRun& board, const protocol::ParameterSet& parameters, Result& result);

}  // namespace inkwell::campaign
