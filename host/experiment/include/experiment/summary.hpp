// What the recordings of the experiment say, in numbers. Pure: recordings in, figures out.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <experiment/recording.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::experiment {

/// One wall of the box.
struct Wall {
  int axis = 2;  ///< 0 x, 1 y, 2 z
  int side = 1;  ///< 1 the upper wall, -1 the lower one
  bool operator==(const Wall&) const = default;
};

/// "z+" and the like. Throws device::Error.
Wall parse_wall(const std::string& name);
std::string wall_name(Wall wall);
/// The wall in the arm's plane, away from its base: pushing into it takes no torque about the waist.
Wall forward_wall(const protocol::ParameterSet& parameters);
/// Where the wall stands along its axis, in metres.
double wall_position_m(const protocol::ParameterSet& parameters, Wall wall);
char axis_letter(int axis);

struct Interval {
  double from_s = 0;
  double to_s = 0;
};

/// The answer of one motor's current to a step of its reference.
struct CurrentStep {
  double amplitude_A = 0;     ///< of the reference
  double rise_time_s = 0;     ///< from the step of the reference to 63.2 % of it, between samples by interpolation
  double overshoot = 0;       ///< largest current beyond the reference, as a part of it; noise included
  double steady_error_A = 0;  ///< mean of current minus reference over the second half of the pulse
};

/// Looks for the first pulse in the reference. Throws device::Error if there is none or the current never rises.
CurrentStep current_step(const std::vector<double>& reference_A, const std::vector<double>& current_A,
                         double sample_period_s);

/// Comparison of the force that the firmware logged with F = k d + c d' of the values that it logged beside it.
struct ForceLaw {
  std::size_t samples = 0;  ///< in contact
  double error_maximum_N = 0;
  double error_maximum_relative = 0;  ///< of the samples with more than 0.5 N
  std::size_t samples_outside = 0;    ///< error over 1 % and over 5 mN
};
ForceLaw force_law(const Recording& recording, const protocol::ParameterSet& parameters);

/// How still the arm is while the hand holds steady against the wall.
struct SteadyHold {
  Interval interval;
  std::array<double, 3> encoder_spread_counts{};  ///< largest minus smallest
  double position_spread_m = 0;                   ///< along the wall's axis
  double penetration_mean_m = 0;
};
SteadyHold steady_hold(const Recording& recording, Wall wall, Interval interval);
/// The steadiest half second with at least half of the largest penetration; none if contact was shorter.
std::optional<Interval> find_steady_hold(const Recording& recording, Wall wall);

struct WallResult {
  std::size_t samples = 0;
  std::size_t samples_in_contact = 0;
  double penetration_maximum_m = 0;
  double force_maximum_N = 0;
  double torque_1_maximum_Nm = 0;       ///< magnitude; the paper's T1z
  double other_torques_maximum_Nm = 0;  ///< magnitude of T2x and T3x
  ForceLaw force_law;
  std::optional<SteadyHold> steady_hold;
  std::optional<Interval> contact;  ///< from the first touch to the last
};
WallResult evaluate(const Recording& recording, const protocol::ParameterSet& parameters, Wall wall,
                    std::optional<Interval> hold);

}  // namespace inkwell::experiment
