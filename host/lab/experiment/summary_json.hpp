// The JSON summary of an experiment.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "host/client/device/virtual_board.hpp"
#include "host/client/recording/current_step.hpp"
#include "host/lab/experiment/summary.hpp"

namespace inkwell::experiment {

/// Conditions of the recordings.
struct Circumstances {
  recording::Information about;  ///< metadata of the recorded push
  BoxWall wall;
  std::optional<device::VirtualBoardOptions> virtual_board;  ///< options of the board that was started for it
  std::uint64_t poses_received = 0;
  std::uint64_t poses_lost = 0;
};

nlohmann::ordered_json summary_json(const Circumstances& circumstances, const WallResult& result,
                                    const std::vector<recording::CurrentStep>& steps);

}  // namespace inkwell::experiment
