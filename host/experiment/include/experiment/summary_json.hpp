// The summary of an experiment as it is written beside its recording.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include <device/virtual_board.hpp>
#include <experiment/summary.hpp>
#include <recording/current_step.hpp>

namespace inkwell::experiment {

/// How the recordings came about.
struct Circumstances {
  recording::Information about;  ///< of the recording of the push
  BoxWall wall;
  std::optional<device::VirtualBoardOptions> virtual_board;  ///< that was started for it
  std::uint64_t poses_received = 0;
  std::uint64_t poses_lost = 0;
};

nlohmann::ordered_json summary_json(const Circumstances& circumstances, const WallResult& result,
                                    const std::vector<recording::CurrentStep>& steps);

}  // namespace inkwell::experiment
