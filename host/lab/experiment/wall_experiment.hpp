// The experiment of the paper's section 4.3. The sphere approaches a wall, is pressed into the wall, is moved along the
// wall, and is released. Every control period is recorded. A simulated hand or the user moves the sphere.
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
  /// Values for the experiment; std::nullopt: the values of the device, which are restored afterwards.
  std::optional<double> stiffness_N_per_m, damping_Ns_per_m;
  std::optional<BoxWall> wall;                               ///< std::nullopt: the forward wall of the arm
  std::optional<device::VirtualBoardOptions> virtual_board;  ///< of the board started for the experiment
};

/// Receives each step and the completed fraction (0..1).
using Progress = std::function<void(std::string_view step, double done)>;

/// Throws device::Error if the folder contains an experiment, which would be overwritten.
void check_has_no_experiment(const std::filesystem::path& directory);

/// `hand` is null if the user moves the sphere. Writes recording.csv, current-step.csv, figure-11.png to figure-14.png
/// and summary.json, and returns the summary. Throws device::Error, for example if a recording has gaps.
nlohmann::ordered_json run_wall_experiment(device::Device& device, device::ControlClient* hand,
                                           const WallOptions& options, const Progress& progress);

}  // namespace inkwell::experiment
