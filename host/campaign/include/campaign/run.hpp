// Runs one case on a virtual board of its own.
#pragma once

#include <campaign/cases.hpp>
#include <campaign/result.hpp>
#include <device/virtual_board.hpp>

namespace inkwell::campaign {

/// So long after the fault came, bridges and hand are watched.
inline constexpr double observed_s = 0.3;

/// The same case gives the same result on any machine. What keeps it from being run is told in Result::error.
Result run_case(const Case& the_case, device::VirtualBoardOptions board = {});

}  // namespace inkwell::campaign
