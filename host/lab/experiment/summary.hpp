// Computes the numerical results of the experiment.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/client/recording/recording.hpp"
#include "host/client/recording/stored_recording.hpp"
#include "host/lab/experiment/wall.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::experiment {

/// Times since the first sample of a recording.
struct Interval {
  double from_s = 0;
  double to_s = 0;
};

/// Difference between the logged force and F = k d + c d'.
struct ForceLawError {
  std::size_t samples = 0;  ///< in contact
  double maximum_N = 0;
  double maximum_relative = 0;      ///< of the samples with more than 0.5 N
  std::size_t samples_outside = 0;  ///< error over 1 % and over 5 mN
};
ForceLawError force_law_error(const recording::Recording& recording, const protocol::ParameterSet& parameters);

/// Residual motion of the arm during a steady hold.
struct SteadyHold {
  Interval interval;
  std::array<double, 3> encoder_spread_counts{};  ///< largest minus smallest
  double position_spread_m = 0;                   ///< along the wall's axis
  double penetration_mean_m = 0;
};
SteadyHold steady_hold(const recording::Recording& recording, BoxWall wall, Interval interval);
/// Returns the steadiest half second with at least half of the largest penetration. Returns std::nullopt if the contact
/// was shorter than half a second.
std::optional<Interval> find_steady_hold(const recording::Recording& recording, BoxWall wall);

/// Returns the interval from the first to the last contact, or std::nullopt without contact.
std::optional<Interval> contact_with(const recording::StoredRecording& recording, BoxWall wall);

struct WallResult {
  std::size_t samples = 0;
  std::uint64_t samples_lost = 0;
  std::size_t samples_in_contact = 0;
  double penetration_maximum_m = 0;
  double force_maximum_N = 0;
  double torque_1_maximum_Nm = 0;       ///< magnitude; the paper's T1z
  double other_torques_maximum_Nm = 0;  ///< magnitude of T2x and T3x
  ForceLawError force_law_error;
  std::optional<SteadyHold> steady_hold;
  std::optional<Interval> contact;
};
/// If `hold` is std::nullopt, find_steady_hold() provides the interval.
WallResult evaluate(const recording::Recording& recording, const protocol::ParameterSet& parameters, BoxWall wall,
                    std::optional<Interval> hold);

}  // namespace inkwell::experiment
