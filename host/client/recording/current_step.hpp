// Evaluates a recorded current step.
#pragma once

#include <vector>

namespace inkwell::recording {

/// Response of a motor's current to a step of its reference.
struct CurrentStep {
  double amplitude_A = 0;     ///< of the reference
  double rise_time_s = 0;     ///< from the reference step to 63.2 % of it, interpolated between samples
  double overshoot = 0;       ///< largest current above the reference, as a fraction of it; noise included
  double steady_error_A = 0;  ///< mean of current minus reference over the second half of the pulse
};

/// Evaluates the first pulse in the reference. Both arguments contain one current in ampere for each control period.
/// Throws device::Error if the recording contains no pulse or if the current never rises.
CurrentStep current_step(const std::vector<float>& reference_A, const std::vector<float>& current_A);

}  // namespace inkwell::recording
