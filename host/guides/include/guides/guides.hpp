// The guides that there are.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <guides/guide.hpp>

namespace inkwell::guides {

/// Versions, supply, state, inkwell, each encoder's direction while the user turns the joint, buttons. No current.
Guide first_connection_guide();

/// Referencing: the stylus rests in the inkwell and the pose is compared with the inkwell's angles.
Guide inkwell_guide();

/// What is trusted when counts and stops disagree.
enum class StopsTrust : std::uint8_t {
  limits,    ///< the arm's limits: counts per turn or the inkwell's angles are wrong
  encoders,  ///< counts and inkwell: the limits are to be moved to where the stops were found
};
/// The user moves each joint to both stops.
Guide stops_guide(StopsTrust trust);

struct AngleRange {
  double minimum_rad;
  double maximum_rad;
};
struct PotentiometerOptions {
  /// Between the gimbal's stops; none: what the arm's description says of the whole track.
  std::array<std::optional<AngleRange>, 3> range;
  bool quadratic = false;  ///< a third point in the middle gives the square term
};
/// The user turns each axis of the gimbal to both stops.
Guide potentiometer_guide(const PotentiometerOptions& options);

inline constexpr double bandwidth_default_Hz = 800, bandwidth_minimum_Hz = 50, bandwidth_maximum_Hz = 2000;
struct CurrentLoopOptions {
  std::vector<int> motors{1, 2, 3};
  double bandwidth_Hz = bandwidth_default_Hz;
};
/// Identifies each motor, suggests gains and tries them.
Guide current_loop_guide(const CurrentLoopOptions& options);

/// First the encoders, turned by the user, then a pulse of current in each motor.
Guide direction_guide();

}  // namespace inkwell::guides
