// The experiment of the paper's section 4.3. The sphere approaches a wall, is pressed into the wall, is moved along the
// wall, and is released. Every control period is recorded. A virtual board uses a simulated hand; with a real board the
// user moves the sphere.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "host/client/device/control_client.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"
#include "host/lab/experiment/wall.hpp"

namespace inkwell::experiment {

struct WallOptions {
  std::filesystem::path output_directory;
  std::string arm;  ///< if empty, recognized by default parameters
  bool simulation = false;
  std::optional<BoxWall> wall;                               ///< std::nullopt: the forward wall of the arm
  std::optional<device::VirtualBoardOptions> virtual_board;  ///< of the board started for the experiment
};

/// Called at every step with its description for the user and the completed fraction (0..1).
using Progress = std::function<void(std::string_view step, double done)>;

/// `hand`: control client of the device's virtual board, or null if the user pushes. The simulated hand pushes, and
/// board time passes only at the experiment's request. Writes recording.csv, current-step.csv, figure-11.png to
/// figure-14.png and summary.json, and returns the summary. Throws device::Error, also if a recording has gaps.
nlohmann::ordered_json run_wall_experiment(device::Device& device, device::ControlClient* hand,
                                           const WallOptions& options, const Progress& progress);

}  // namespace inkwell::experiment
