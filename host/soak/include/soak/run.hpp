// Runs sittings on virtual boards of their own.
#pragma once

#include <functional>
#include <string>

#include <device/virtual_board.hpp>
#include <soak/result.hpp>

namespace inkwell::soak {

struct Choices {
  std::uint64_t seed = 1;
  double sitting_s = 300;  ///< board time; a phase that has begun is ended, and each kind comes once at least
  double use_s = 4;        ///< the longest use in a phase, of board time
};

/// The same sitting does the same on any machine, whatever other sittings there are. `tell` gets a line on each phase
/// and finding. What ends it too early is a finding as well.
Sitting run_sitting(unsigned number, const Choices& choices, device::VirtualBoardOptions board,
                    const std::function<void(const std::string&)>& tell = {});

/// How many of them have so much board time together.
unsigned sittings_in(double board_time_s, const Choices& choices);

}  // namespace inkwell::soak
