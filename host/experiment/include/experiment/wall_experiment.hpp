// The paper's section 4.3: the sphere is taken to a wall, pressed into it, dragged along it and let go, while every
// control period is recorded. With a virtual board a simulated hand does it, with a real one the user.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <device/control_client.hpp>
#include <device/device.hpp>
#include <device/virtual_board.hpp>
#include <experiment/wall.hpp>

namespace inkwell::experiment {

struct WallOptions {
  std::filesystem::path output_directory;
  std::string arm;              ///< its name; if it is empty, known by the parameters where they are the default ones
  bool simulation = false;      ///< the device is virtual
  std::optional<BoxWall> wall;  ///< none: the forward wall of the arm
  std::optional<device::VirtualBoardOptions> virtual_board;  ///< that was started for the experiment
};

/// Told about every step: what happens now, for the user to read, and how much of the whole is done (0..1).
using Progress = std::function<void(std::string_view step, double done)>;

/// `hand`: of the virtual board that the device is on, whose simulated hand pushes and whose time stands by, passing
/// only as the experiment asks; null leaves the push to the user. Writes recording.csv, current-step.csv, figure-11.png
/// to figure-14.png and summary.json, and returns the summary. Throws device::Error; nothing is called a result that
/// has gaps.
nlohmann::ordered_json run_wall_experiment(device::Device& device, device::ControlClient* hand,
                                           const WallOptions& options, const Progress& progress);

}  // namespace inkwell::experiment
