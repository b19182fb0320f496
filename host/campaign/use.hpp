// What becomes of a fault that was not noticed while the arm was left as it was: the hand goes on to use the arm.
#pragma once

#include <campaign/board_run.hpp>
#include <campaign/result.hpp>

namespace inkwell::campaign {

/// Goes on as before for a while, presses the arm into the wall in front of it, then swings it, until the board tells a
/// fault. Fills in
/// what the result says about use. Throws device::Error if the device cannot be asked.
void use_on(BoardRun& board, Result& result);

}  // namespace inkwell::campaign
