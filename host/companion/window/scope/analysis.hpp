// Statistics and spectrum of a section of a signal.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "host/companion/window/scope/signal_history.hpp"

namespace inkwell::window {

/// Statistics of the received samples. Without received samples, `count` is 0 and all other members are NaN.
struct Statistics {
  std::uint64_t count;
  double minimum;
  double maximum;
  double mean;
  double root_mean_square;
  double standard_deviation;
};

inline constexpr double unknown_statistic = std::numeric_limits<double>::quiet_NaN();
/// The statistics without samples.
inline constexpr Statistics no_statistics{
    0, unknown_statistic, unknown_statistic, unknown_statistic, unknown_statistic, unknown_statistic};

Statistics statistics(const SignalSeries& series, std::uint64_t first, std::uint64_t last);

/// Amplitude spectrum in the signal's unit. The frequency of amplitudes[i] is i * resolution_Hz.
struct Spectrum {
  double resolution_Hz = 0.0;
  std::vector<double> amplitudes;
};

/// Returns the spectrum of the newest samples in [first, last). Removes the mean and applies a Hann window. The number
/// of samples is a power of two, at most 32768. The spectrum is empty if a sample was lost or if there are fewer than
/// 16 samples.
Spectrum spectrum(const SignalSeries& series, std::uint64_t first, std::uint64_t last);

/// Returns true if the newest samples exceed the previous range of the signal by more than typical noise.
bool leaves_range(Extremes newest, Extremes before, double value_of_a_pixel);

}  // namespace inkwell::window
