#include "host/client/recording/current_step.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "host/client/device/error.hpp"
#include "protocol/reports.hpp"

namespace inkwell::recording {
namespace {

constexpr double rise_level = 0.632;  // level of a first-order response after one time constant

}  // namespace

CurrentStep current_step(const std::vector<float>& reference_A, const std::vector<float>& current_A) {
  double largest = 0;
  for (const double reference : reference_A)
    if (std::abs(reference) > std::abs(largest)) largest = reference;
  if (largest == 0) throw device::Error("The current test did not reach the motor. Check that the state is ready.");
  const auto is_on = [&](double reference) { return reference / largest > 0.5; };
  const auto begin = std::find_if(reference_A.begin(), reference_A.end(), is_on);
  const auto end = std::find_if_not(begin, reference_A.end(), is_on);
  const auto first = static_cast<std::size_t>(begin - reference_A.begin());
  const auto last = static_cast<std::size_t>(end - reference_A.begin());

  CurrentStep step;
  step.amplitude_A = largest;
  bool risen = false;
  double previous = 0, sum = 0;
  const std::size_t middle = first + (last - first) / 2;
  for (std::size_t i = first; i < last; ++i) {
    const double part = static_cast<double>(current_A[i]) / largest;
    if (!risen && part >= rise_level) {
      const double fraction = part > previous ? (rise_level - previous) / (part - previous) : 1.0;
      step.rise_time_s = std::max(0.0, static_cast<double>(i - first) - 1.0 + fraction) / protocol::servo_rate_Hz;
      risen = true;
    }
    previous = part;
    step.overshoot = std::max(step.overshoot, part - 1.0);
    if (i >= middle) sum += static_cast<double>(current_A[i]) - static_cast<double>(reference_A[i]);
  }
  if (!risen)
    throw device::Error("The motor's current does not follow its reference. Check the motor's wiring and supply.");
  step.steady_error_A = sum / static_cast<double>(last - middle);
  return step;
}

}  // namespace inkwell::recording
