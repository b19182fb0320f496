#include "host/companion/window/scope/analysis.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include <fftw3.h>

#include "protocol/reports.hpp"

namespace inkwell::window {

Statistics statistics(const SignalSeries& series, std::uint64_t first, std::uint64_t last) {
  first = std::max(first, series.begin());
  last = std::min(last, series.end());
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  Statistics result{0, nothing, nothing, nothing, nothing, nothing};
  // Welford's algorithm is accurate even for a small ripple on a large mean.
  double mean = 0.0;
  double squares_about_mean = 0.0;
  double squares = 0.0;
  for (std::uint64_t i = first; i < last; ++i) {
    const double value = series[i];
    if (std::isnan(value)) continue;
    ++result.count;
    const double step = value - mean;
    mean += step / static_cast<double>(result.count);
    squares_about_mean += step * (value - mean);
    squares += value * value;
  }
  if (result.count == 0) return result;
  const Extremes extremes = series.extremes(first, last);
  result.minimum = extremes.minimum;
  result.maximum = extremes.maximum;
  result.mean = mean;
  result.root_mean_square = std::sqrt(squares / static_cast<double>(result.count));
  result.standard_deviation = std::sqrt(squares_about_mean / static_cast<double>(result.count));
  return result;
}

Spectrum spectrum(const SignalSeries& series, std::uint64_t first, std::uint64_t last) {
  constexpr std::uint64_t samples_minimum = 16;
  constexpr std::uint64_t samples_maximum = 32768;
  first = std::max(first, series.begin());
  last = std::min(last, series.end());
  if (last < first + samples_minimum) return {};
  const std::uint64_t count = std::min(std::bit_floor(last - first), samples_maximum);

  const std::unique_ptr<double[], decltype(&fftw_free)> input(fftw_alloc_real(count), fftw_free);
  const std::unique_ptr<fftw_complex[], decltype(&fftw_free)> output(fftw_alloc_complex(count / 2 + 1), fftw_free);
  double mean = 0.0;
  for (std::uint64_t i = 0; i < count; ++i) mean += static_cast<double>(series[last - count + i]);
  mean /= static_cast<double>(count);
  if (std::isnan(mean)) return {};
  for (std::uint64_t i = 0; i < count; ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    input[i] = (static_cast<double>(series[last - count + i]) - mean) * (0.5 - 0.5 * std::cos(phase));
  }
  const fftw_plan plan = fftw_plan_dft_r2c_1d(static_cast<int>(count), input.get(), output.get(), FFTW_ESTIMATE);
  fftw_execute(plan);
  fftw_destroy_plan(plan);

  Spectrum result{static_cast<double>(protocol::servo_rate_Hz) / static_cast<double>(count), {}};
  result.amplitudes.reserve(count / 2 + 1);
  // The unused half of the spectrum and the mean of the Hann window each require a factor of 2.
  const double scale = 4.0 / static_cast<double>(count);
  for (std::uint64_t i = 0; i <= count / 2; ++i)
    result.amplitudes.push_back(scale * std::hypot(output[i][0], output[i][1]));
  return result;
}

bool leaves_range(Extremes newest, Extremes before, double value_of_a_pixel) {
  // Noise rarely exceeds its previous range by more than this fraction.
  constexpr float noise_part = 0.25f;
  const float margin = std::max(static_cast<float>(value_of_a_pixel), noise_part * (before.maximum - before.minimum));
  return newest.minimum < before.minimum - margin || newest.maximum > before.maximum + margin;
}

}  // namespace inkwell::window
