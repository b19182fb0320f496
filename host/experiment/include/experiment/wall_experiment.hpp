// The paper's section 4.3: the sphere is taken to a wall, pressed into it, dragged along it and let go, while every
// control period is recorded. With a virtual board a simulated hand does it, with a real one the user.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <device/virtual_board.hpp>
#include <experiment/figures.hpp>
#include <experiment/summary.hpp>

namespace inkwell::experiment {

struct WallOptions {
  std::filesystem::path output_directory;
  /// The board to simulate; none takes the real device at `endpoint`.
  std::optional<device::VirtualBoardOptions> virtual_board;
  std::optional<device::Endpoint> endpoint;
  std::optional<Wall> wall;  ///< none: the forward wall of the arm
};

/// Told about every step: what happens now, for the user to read, and how much of the whole is done (0..1).
using Progress = std::function<void(std::string_view step, double done)>;

/// How the recordings came about.
struct Circumstances {
  bool simulation = false;
  std::string arm;
  std::string firmware_version;
  std::string serial_number;
  std::string mode;        ///< of the simulation
  std::uint64_t seed = 0;  ///< of the simulation
  protocol::ParameterSet parameters{};
  Wall wall;
  std::uint64_t poses_received = 0;
  std::uint64_t poses_lost = 0;
  std::uint64_t samples_lost = 0;
};

nlohmann::ordered_json summary_json(const Circumstances& circumstances, const WallResult& result,
                                    const std::vector<CurrentStep>& steps);

/// Writes recording.csv, current-step.csv, figure-11.png to figure-14.png and summary.json, and returns the summary.
/// Throws device::Error; nothing is called a result that has gaps.
nlohmann::ordered_json run_wall_experiment(const WallOptions& options, const Progress& progress);

}  // namespace inkwell::experiment
