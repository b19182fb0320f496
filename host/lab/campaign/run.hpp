// Runs one case on a separate virtual board.
#pragma once

#include "host/client/device/virtual_board.hpp"
#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/result.hpp"

namespace inkwell::campaign {

/// Observation time after the injection.
inline constexpr double observed_s = 0.3;
/// After an undetected fault with the force on, the use of the arm continues. The situation first continues for this
/// time. The hand then presses into the forward wall and the side wall at the force limit, so that each motor carries
/// load. Finally the hand swings.
inline constexpr double goes_on_s = 0.6;
inline constexpr int use_presses = 2, use_swings = 4;

/// The result does not depend on the machine. If the case cannot be run, Result::error states the reason.
Result run_case(const Case& the_case, device::VirtualBoardOptions board = {});

}  // namespace inkwell::campaign
