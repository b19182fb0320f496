// Numbers about a stretch of a signal: statistics and spectrum.
#pragma once

#include <cstdint>
#include <vector>

#include <scope/signal_history.hpp>

namespace inkwell::window {

/// Lost samples are left out; `count` is 0, and the rest NaN, if nothing is left.
struct Statistics {
  std::uint64_t count;
  double minimum;
  double maximum;
  double mean;
  double root_mean_square;
  double standard_deviation;
};

Statistics statistics(const SignalSeries& series, std::uint64_t first, std::uint64_t last);

/// Amplitude of the sines a signal is made of: amplitudes[i] at i * resolution_Hz, in the signal's unit.
struct Spectrum {
  double resolution_Hz = 0.0;
  std::vector<double> amplitudes;
};

/// Of the newest power of two of samples that fits into [first, last), at most 32768. A Hann window keeps strong
/// lines from spilling over weak ones; its loss of amplitude is made up for, and the mean is taken off before.
/// Empty if there are fewer than 16 samples or one of them was lost.
Spectrum spectrum(const SignalSeries& series, std::uint64_t first, std::uint64_t last);

/// True if the newest samples of a signal leave the range that it had before. Noise widens its range now and then by
/// a little, which is not motion.
bool leaves_range(Extremes newest, Extremes before, double value_of_a_pixel);

}  // namespace inkwell::window
