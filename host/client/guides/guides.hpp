// List of the guides and their options.
#pragma once

// To add a guide:
// (1) Add a line to INKWELL_GUIDES.
// (2) Write host/client/guides/NAME_guide.cpp with the plan of the steps and an `Offer` named NAME_guide. Access the
//     device only through DevicePort.
// (3) Add options of the guide to Choices and to the command of its group in host/companion/command_line.
// (4) Add a test with a simulated arm to tests/host/client/guides. Add a new subcommand to the list in
//     tests/system/bad_input_test.cpp.
//
// The window and the command line use this list.

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "host/client/guides/guide.hpp"

namespace inkwell::guides {

/// Reference for a disagreement between encoder counts and stops.
enum class StopsTrust : std::uint8_t {
  limits,    ///< limits of the arm: counts per turn or inkwell angles are wrong
  encoders,  ///< counts and inkwell: the limits must be changed to the found stops
};

struct AngleRange {
  double minimum_rad;
  double maximum_rad;
};
struct PotentiometerOptions {
  /// Angles of the gimbal's stops. With std::nullopt, the arm description provides the angles.
  std::array<std::optional<AngleRange>, 3> range;
  bool quadratic = false;  ///< a third point in the middle determines the square term
};

inline constexpr double bandwidth_default_Hz = 800, bandwidth_minimum_Hz = 50, bandwidth_maximum_Hz = 2000;
struct CurrentLoopOptions {
  std::vector<int> motors{1, 2, 3};
  double bandwidth_Hz = bandwidth_default_Hz;
  std::filesystem::path pulses;  ///< new recording of all pulses; empty: none
};

/// The user may choose these options before a guide starts. Each guide reads only the options that it uses.
struct Choices {
  StopsTrust trust = StopsTrust::limits;
  PotentiometerOptions potentiometers;
  CurrentLoopOptions current_loop;
};

/// A guide in the window and on the command line.
struct Offer {
  std::string_view group;  ///< parent command
  std::string_view name;   ///< name on the command line and in the result
  std::string_view title;
  std::string_view help;  ///< description in one sentence
  Plan (*plan)(const Choices& choices);

  Guide start(const Choices& choices = {}) const;
};

/// The guides, in their usual order for a new arm.
#define INKWELL_GUIDES(X) \
  X(connection)           \
  X(directions)           \
  X(inkwell)              \
  X(stops)                \
  X(potentiometer)        \
  X(current_loop)

#define X(name) extern const Offer name##_guide;
INKWELL_GUIDES(X)
#undef X

std::span<const Offer* const> all_guides();

}  // namespace inkwell::guides
