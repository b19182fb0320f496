// Tests the adaptive-window velocity estimator with motions of known speed. Speeds are in counts per period. On the
// Omni one count is about 0.05 mm at the probe, so one count per period is 1.1 m/s.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/signal_path/velocity.hpp"
#include "protocol/reports.hpp"

namespace {

using namespace inkwell;
using control::SpeedEstimate;

constexpr double rate_Hz = protocol::servo_rate_Hz;
constexpr double pi = 3.14159265358979;

std::int32_t counts_at(double position) { return static_cast<std::int32_t>(std::floor(position)); }

struct Quality {
  double rms;              ///< of the estimation error, in counts per second
  double raw_rms;          ///< of the error of the difference of two samples
  double lag_s;            ///< time shift equivalent to the phase of the sine
  double amplitude_ratio;  ///< estimated amplitude relative to the true amplitude
};

/// Estimates the speed of `amplitude_counts` sin(2 pi f t) over whole periods, after one settling period.
Quality follow_sine(double amplitude_counts, double frequency_Hz) {
  const double omega = 2 * pi * frequency_Hz;
  const auto turn = static_cast<std::uint32_t>(rate_Hz / frequency_Hz);
  const std::uint32_t turns = turn < 20'000 ? 4 : 2;
  SpeedEstimate estimate;
  double square = 0, raw_square = 0, in_phase = 0, quadrature = 0;
  std::int32_t before = 0;
  for (std::uint32_t period = 1; period <= turns * turn; ++period) {
    const double t = period / rate_Hz;
    const std::int32_t counts = counts_at(amplitude_counts * std::sin(omega * t) + 0.37);
    estimate.update(counts, period);
    const double truth = amplitude_counts * omega * std::cos(omega * t);
    const double value = estimate.counts_per_period * rate_Hz;
    const double raw = (counts - before) * rate_Hz;
    before = counts;
    if (period <= turn) continue;
    square += (value - truth) * (value - truth);
    raw_square += (raw - truth) * (raw - truth);
    in_phase += value * std::cos(omega * t);
    quadrature += value * std::sin(omega * t);
  }
  const double samples = static_cast<double>((turns - 1) * turn);
  const double size = 2 * std::hypot(in_phase, quadrature) / samples;
  return {std::sqrt(square / samples), std::sqrt(raw_square / samples), std::atan2(quadrature, in_phase) / omega,
          size / (amplitude_counts * omega)};
}

TEST_CASE("a hand's sine of 2 Hz and 16 mm: small error, little lag, far better than a difference") {
  const Quality quality = follow_sine(300, 2);
  const double peak = 300 * 2 * pi * 2;
  MESSAGE("RMS error " << 100 * quality.rms / peak << " % of the peak speed (raw difference "
                       << 100 * quality.raw_rms / peak << " %), lag " << 1e3 * quality.lag_s << " ms");
  CHECK(quality.rms < 0.03 * peak);
  CHECK(quality.rms < 0.05 * quality.raw_rms);
  CHECK(quality.lag_s < 3e-3);
  CHECK(quality.lag_s > 0);
  CHECK(quality.amplitude_ratio == doctest::Approx(1.0).epsilon(0.02));
}

TEST_CASE("a fast shake of 20 Hz and 5 mm") {
  const Quality quality = follow_sine(100, 20);
  const double peak = 100 * 2 * pi * 20;
  MESSAGE("RMS error " << 100 * quality.rms / peak << " % of the peak speed (raw difference "
                       << 100 * quality.raw_rms / peak << " %), lag " << 1e3 * quality.lag_s << " ms");
  CHECK(quality.rms < 0.09 * peak);
  CHECK(quality.rms < 0.15 * quality.raw_rms);
  CHECK(quality.lag_s < 1e-3);
}

TEST_CASE("constant speeds from 0.5 mm/s to 3 m/s") {
  for (const double counts_per_s : {10.0, 37.0, 200.0, 1'234.0, 9'000.0, 20'000.0, 33'333.0, 60'000.0}) {
    CAPTURE(counts_per_s);
    for (const double sign : {1.0, -1.0}) {
      SpeedEstimate estimate;
      const auto periods = static_cast<std::uint32_t>(std::max(4'000.0, 40 * rate_Hz / counts_per_s));
      double worst = 0;
      for (std::uint32_t period = 1; period <= periods; ++period) {
        estimate.update(counts_at(sign * counts_per_s * period / rate_Hz), period);
        if (period > periods / 2)
          worst = std::max(worst, std::abs(estimate.counts_per_period * rate_Hz - sign * counts_per_s) / counts_per_s);
      }
      // The estimator's window covers at least 56 periods and four counts. The estimated speed is wrong by at most one
      // period or one count per window.
      const double window_periods = std::max(56.0, 3.9 * rate_Hz / counts_per_s);
      CHECK(worst < 1.0 / window_periods / std::max(1.0, counts_per_s / rate_Hz));
    }
  }
}

TEST_CASE("joints that take turns lag by a tenth of a millisecond more and are as exact") {
  for (const double counts_per_s : {200.0, 9'000.0, 33'333.0}) {
    CAPTURE(counts_per_s);
    SpeedEstimate every, third;
    double worst = 0;
    for (std::uint32_t period = 1; period <= 8'000; ++period) {
      const std::int32_t counts = counts_at(counts_per_s * period / rate_Hz);
      every.update(counts, period);
      third.update(counts, period, period % 3 == 0);
      if (period > 4'000)
        worst = std::max(worst, std::abs(third.counts_per_period * rate_Hz - counts_per_s) / counts_per_s);
    }
    CHECK(worst < 1.0 / 56);
    CHECK(third.counts_per_period == doctest::Approx(every.counts_per_period).scale(0).epsilon(0.03));
  }
}

TEST_CASE("at rest it is exactly zero, also after motion and while a count dithers") {
  SpeedEstimate estimate;
  estimate.start(1'000, 0);
  std::uint32_t period = 1;
  for (; period < 100; ++period) estimate.update(1'000, period);
  CHECK(estimate.counts_per_period == 0.0f);
  for (std::int32_t i = 0; i < 50; ++i, period += 10) estimate.update(1'000 + i, period);
  CHECK(estimate.counts_per_period == doctest::Approx(0.1f));
  for (std::uint32_t i = 0; i < SpeedEstimate::rest_periods; ++i) estimate.update(1'049, ++period);
  CHECK(estimate.counts_per_period == 0.0f);
  for (int i = 0; i < 100; ++i) {
    estimate.update(1'049 + i % 2, period += 7);
    CHECK(estimate.counts_per_period == 0.0f);
  }
}

TEST_CASE("after a sudden stop the speed is bounded by one count in the time of silence") {
  SpeedEstimate estimate;
  std::uint32_t period = 0;
  for (std::int32_t counts = 1; counts < 200; ++counts) estimate.update(counts, period += 4);
  CHECK(estimate.counts_per_period == doctest::Approx(0.25f));
  for (std::uint32_t silent = 1; silent < 1'000; ++silent) {
    estimate.update(199, ++period);
    CHECK(estimate.counts_per_period <= 0.25001f);
    CHECK(estimate.counts_per_period <= 1.0625f / static_cast<float>(silent) + 1e-6f);
    CHECK(estimate.counts_per_period > 0.0f);
  }
}

TEST_CASE("between edges the value rests: it changes in few of the periods") {
  SpeedEstimate estimate;
  int changes = 0;
  float before = 0.0f;
  constexpr std::uint32_t periods = 20'000;
  for (std::uint32_t period = 1; period <= periods; ++period) {
    // In half a second the speed decreases from 500 to 250 counts per second, and then the motion stops.
    const double t = std::min(period / rate_Hz, 0.5);
    estimate.update(counts_at(500 * t - 250 * t * t), period);
    if (estimate.counts_per_period != before) ++changes;
    before = estimate.counts_per_period;
  }
  CHECK(changes < 320);
  CHECK(changes > 50);
}

TEST_CASE("the period counter may wrap") {
  SpeedEstimate estimate;
  estimate.start(0, 0xFFFFFF00u);
  std::uint32_t period = 0xFFFFFF00u;
  for (std::int32_t counts = 1; counts < 100; ++counts) {
    estimate.update(counts, period += 5);
    if (counts > 2) CHECK(estimate.counts_per_period == doctest::Approx(0.2f));
  }
}

TEST_CASE("lost or garbled counts give numbers, not nonsense") {
  SpeedEstimate estimate;
  std::int32_t counts = 0;
  for (std::uint32_t period = 1; period < 2'000; ++period) {
    counts += period % 97 == 0 ? 30'000 : 1;
    estimate.update(counts, period);
    CHECK(estimate.counts_per_period >= 0.0f);
    CHECK(estimate.counts_per_period <= 30'001.0f);
  }
}

}  // namespace
