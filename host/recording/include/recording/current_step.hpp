// What the recording of a step of current says about its loop. Pure: samples in, numbers out.
#pragma once

#include <vector>

namespace inkwell::recording {

/// The answer of one motor's current to a step of its reference.
struct CurrentStep {
  double amplitude_A = 0;     ///< of the reference
  double rise_time_s = 0;     ///< from the step of the reference to 63.2 % of it, between samples by interpolation
  double overshoot = 0;       ///< largest current beyond the reference, as a part of it; noise included
  double steady_error_A = 0;  ///< mean of current minus reference over the second half of the pulse
};

/// Looks for the first pulse in the reference; both are samples of consecutive control periods, in ampere. Throws
/// device::Error if there is none or the current never rises.
CurrentStep current_step(const std::vector<float>& reference_A, const std::vector<float>& current_A);

}  // namespace inkwell::recording
