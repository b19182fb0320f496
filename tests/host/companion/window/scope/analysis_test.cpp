#include <cmath>
#include <numbers>
#include <random>

#include <doctest/doctest.h>

#include "host/companion/window/scope/analysis.hpp"
#include "host/companion/window/scope/statistics_text.hpp"

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
  // The signal has exactly the frequency of spectral line 128, so no energy leaks into other lines.
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

TEST_CASE("noise is no motion, a step and a constant that moves by pixels are") {
  std::mt19937 random{7};
  std::normal_distribution<float> noise{0.0f, 0.01f};
  SignalSeries series(1u << 16);
  for (int i = 0; i < 40'000; ++i) series.append(noise(random));
  int motions = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const auto seen = series.end();
    for (int i = 0; i < 3'333; ++i) series.append(noise(random));
    if (leaves_range(series.extremes(seen, series.end()), series.extremes(seen - 40'000, seen), 0.001)) ++motions;
  }
  CHECK(motions <= 1);  // one of a third of a million samples may be an outlier
  CHECK(leaves_range({-0.01f, 0.08f}, {-0.04f, 0.04f}, 0.001));
  CHECK(leaves_range({0.5f, 0.5f}, {0.4f, 0.4f}, 0.05));
  CHECK_FALSE(leaves_range({0.42f, 0.42f}, {0.4f, 0.4f}, 0.05));
  const float lost = std::nanf("");
  CHECK_FALSE(leaves_range({lost, lost}, {0.0f, 1.0f}, 0.1));
  CHECK_FALSE(leaves_range({0.0f, 1.0f}, {lost, lost}, 0.1));
}

TEST_CASE("every text of the statistics has the unit, and shorter texts are available for narrow plots") {
  const Statistics statistics{10, -0.001, 0.002, 0.0005, 0.0007, 0.0004};
  const auto lines = statistics_lines(statistics, shown_unit("m"));
  REQUIRE(lines.size() > 2);
  CHECK(lines.front() == "mean 0.5 mm   rms 0.7 mm   deviation 0.4 mm   -1 to 2 mm");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CHECK(lines[i].ends_with(" mm"));
    if (i > 0) CHECK(lines[i].size() < lines[i - 1].size());
  }
}
