// Runs sittings on separate virtual boards.
#pragma once

#include <functional>
#include <string>

#include "host/client/device/virtual_board.hpp"
#include "host/lab/soak/result.hpp"

namespace inkwell::soak {

struct Choices {
  std::uint64_t seed = 1;
  double sitting_s = 300;  ///< board time; the phase at the end is cut off
  double use_s = 4;        ///< longest use in a phase, in board time
};

/// The result depends neither on the machine nor on other sittings. `print` receives a line for each phase and finding.
/// An early end is a finding unless `is_stopped` has returned true. `is_stopped` is polled continuously.
Sitting run_sitting(unsigned number, const Choices& choices, device::VirtualBoardOptions board,
                    const std::function<void(const std::string&)>& print = {},
                    const std::function<bool()>& is_stopped = {});

/// Returns the number of sittings for this board time.
unsigned sittings_in(double board_time_s, const Choices& choices);

}  // namespace inkwell::soak
