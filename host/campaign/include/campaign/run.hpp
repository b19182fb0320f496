// Runs one case on a virtual board of its own.
#pragma once

#include <campaign/cases.hpp>
#include <campaign/result.hpp>
#include <device/virtual_board.hpp>

namespace inkwell::campaign {

/// So long after the fault came, bridges and hand are watched.
inline constexpr double observed_s = 0.3;
/// What was not noticed by then with the force on is used on: as before, until a swinging hand has come to the end of
/// its way, then pressed with the force limit so often into the wall in front and the one to the side, which together
/// load each motor, and swung so often.
inline constexpr double goes_on_s = 0.6;
inline constexpr int use_presses = 2, use_swings = 4;

/// The same case gives the same result on any machine. What keeps it from being run is told in Result::error.
Result run_case(const Case& the_case, device::VirtualBoardOptions board = {});

}  // namespace inkwell::campaign
