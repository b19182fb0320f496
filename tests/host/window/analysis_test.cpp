// Statistics and spectrum against signals whose numbers are known.
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include <window/analysis.hpp>

using namespace inkwell::window;

TEST_CASE("statistics of a sine on a large mean") {
  SignalSeries series(1 << 16);
  for (int i = 0; i < 20'000; ++i)
    series.append(1000.0f + 3.0f * static_cast<float>(std::sin(2.0 * std::numbers::pi * 50.0 * i / 20'000.0)));
  const Statistics result = statistics(series, 0, 20'000);
  CHECK(result.count == 20'000);
  CHECK(result.mean == doctest::Approx(1000.0).epsilon(1e-6));
  CHECK(result.standard_deviation == doctest::Approx(3.0 / std::numbers::sqrt2).epsilon(1e-3));
  CHECK(result.minimum == doctest::Approx(997.0).epsilon(1e-6));
  CHECK(result.maximum == doctest::Approx(1003.0).epsilon(1e-6));
  CHECK(result.root_mean_square == doctest::Approx(std::hypot(1000.0, 3.0 / std::numbers::sqrt2)).epsilon(1e-7));
}

TEST_CASE("lost samples are left out of the statistics") {
  SignalSeries series(256);
  for (int i = 0; i < 10; ++i) series.append(i % 2 == 0 ? 4.0f : std::nanf(""));
  const Statistics result = statistics(series, 0, 10);
  CHECK(result.count == 5);
  CHECK(result.mean == 4.0);
  CHECK(statistics(series, 1, 2).count == 0);
  CHECK(std::isnan(statistics(series, 1, 2).mean));
}

TEST_CASE("a sine stands in the spectrum at its frequency with its amplitude") {
  SignalSeries series(1 << 16);
  // Line 128 of 16384 samples exactly, so that none of it leaks.
  const double frequency_Hz = 128.0 * 20'000.0 / 16'384.0;
  for (int i = 0; i < 20'000; ++i)
    series.append(0.7f + 0.25f * static_cast<float>(std::sin(2.0 * std::numbers::pi * frequency_Hz * i / 20'000.0)));
  const Spectrum result = spectrum(series, 0, 20'000);
  REQUIRE(result.amplitudes.size() == 8193);
  CHECK(result.resolution_Hz == doctest::Approx(20'000.0 / 16'384.0));
  CHECK(result.amplitudes[128] == doctest::Approx(0.25).epsilon(1e-3));
  CHECK(result.amplitudes[0] < 1e-3);
  CHECK(result.amplitudes[140] < 1e-6);
}

TEST_CASE("there is no spectrum of too few samples or across a gap") {
  SignalSeries series(256);
  for (int i = 0; i < 64; ++i) series.append(i == 40 ? std::nanf("") : 1.0f);
  CHECK(spectrum(series, 0, 10).amplitudes.empty());
  CHECK(spectrum(series, 0, 64).amplitudes.empty());
  CHECK(spectrum(series, 0, 40).amplitudes.size() == 17);
}
