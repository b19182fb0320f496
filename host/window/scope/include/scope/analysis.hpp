// Statistics and spectrum of a stretch of a signal.
#pragma once

#include <cstdint>
#include <vector>

#include <scope/signal_history.hpp>

namespace inkwell::window {

/// Lost samples are omitted. If no sample remains, `count` is 0 and the other members are NaN.
struct Statistics {
  std::uint64_t count;
  double minimum;
  double maximum;
  double mean;
  double root_mean_square;
  double standard_deviation;
};

Statistics statistics(const SignalSeries& series, std::uint64_t first, std::uint64_t last);

/// Amplitude spectrum in the signal's unit: amplitudes[i] at the frequency i * resolution_Hz.
struct Spectrum {
  double resolution_Hz = 0.0;
  std::vector<double> amplitudes;
};

/// Uses the newest power of two of samples in [first, last), at most 32768. The mean is removed. A Hann window reduces
/// leakage, and its amplitude loss is compensated. Returns an empty spectrum for fewer than 16 samples or if a sample
/// was lost.
Spectrum spectrum(const SignalSeries& series, std::uint64_t first, std::uint64_t last);

/// True if the newest samples of a signal leave its previous range by more than the usual effect of noise.
bool leaves_range(Extremes newest, Extremes before, double value_of_a_pixel);

}  // namespace inkwell::window
