// Runs sittings on virtual boards of their own.
#pragma once

#include <functional>
#include <string>

#include <device/virtual_board.hpp>
#include <soak/result.hpp>

namespace inkwell::soak {

struct Choices {
  std::uint64_t seed = 1;
  double sitting_s = 300;  ///< board time; the phase that goes on then is cut off
  double use_s = 4;        ///< the longest use in a phase, of board time
};

/// The same sitting does the same on any machine, whatever other sittings there are. `tell` gets a line on each phase
/// and finding. What ends it too early is a finding as well, but not `is_stopped`, which is asked all along.
Sitting run_sitting(unsigned number, const Choices& choices, device::VirtualBoardOptions board,
                    const std::function<void(const std::string&)>& tell = {},
                    const std::function<bool()>& is_stopped = {});

/// How many of them share so much board time, if none is longer than choices.sitting_s.
unsigned sittings_in(double board_time_s, const Choices& choices);

}  // namespace inkwell::soak
