// Tests the detection of supply ripple. Supply steps, loads and a braked arm must not be reported as ripple.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "firmware/control/supervision/supply_ripple.hpp"

namespace {

using namespace inkwell;
using control::periods_in;
using control::SupplyRipple;

constexpr float nominal_V = 18.0f, step_V = 0.01f;
constexpr SupplyRipple ripple_check{.tolerance_counts = 100};

std::uint16_t counts_of(float supply_V) { return static_cast<std::uint16_t>(supply_V / step_V); }

constexpr std::uint32_t never = periods_in(2.0f);

/// Checks `supply_V(time_s)` every `every` periods from `begin` on. Returns the number of periods until ripple is
/// reported.
template <class Supply>
std::uint32_t periods_until_ripple(Supply supply_V, std::uint32_t begin = 0, std::uint32_t every = 1) {
  SupplyRipple ripple = ripple_check;
  for (std::uint32_t period = 0; period < never; period += every)
    if (ripple.detect_ripple(counts_of(supply_V(static_cast<float>(period) * protocol::servo_period_s)),
                             begin + period))
      return period;
  return never;
}

auto swing(float amplitude_V, float rate_Hz) {
  return [=](float time_s) {
    return nominal_V + amplitude_V * std::sin(2.0f * std::numbers::pi_v<float> * rate_Hz * time_s);
  };
}

TEST_CASE("a swing of more than a volt at 100 Hz is ripple within a twentieth of a second") {
  CHECK(periods_until_ripple(swing(1.1f, 100.0f)) < periods_in(0.05f));
  CHECK(periods_until_ripple(swing(6.0f, 100.0f)) < periods_in(0.05f));
  CHECK(periods_until_ripple(swing(0.95f, 100.0f)) == never);
}

TEST_CASE(
    "a supply oscillation at 40 Hz or more is ripple within 0.12 s, and an oscillation at 33 Hz or less is not "
    "ripple") {
  for (const float rate_Hz : {40.0f, 50.0f, 120.0f, 300.0f, 1000.0f}) {
    CAPTURE(rate_Hz);
    CHECK(periods_until_ripple(swing(2.0f, rate_Hz)) < periods_in(0.12f));
  }
  for (const float rate_Hz : {1.0f, 5.0f, 10.0f, 20.0f, 33.0f}) {
    CAPTURE(rate_Hz);
    CHECK(periods_until_ripple(swing(5.0f, rate_Hz)) == never);
  }
}

TEST_CASE("a step, a sag, a spike and a supply that is cut are no ripple") {
  for (const float other_V : {0.0f, 12.0f, 15.0f, 24.0f, 30.0f}) {
    CAPTURE(other_V);
    CHECK(periods_until_ripple([=](float time_s) { return time_s < 0.5f ? nominal_V : other_V; }) == never);
    for (const float length_s : {0.0002f, 0.005f, 0.1f})
      CHECK(periods_until_ripple([=](float time_s) {
              return time_s < 0.5f || time_s > 0.5f + length_s ? nominal_V : other_V;
            }) == never);
  }
  // Switching the supply on is not ripple.
  CHECK(periods_until_ripple([](float time_s) { return time_s < 0.5f ? 0.0f : nominal_V; }) == never);
}

TEST_CASE("ripple lasts as long as the supply swings, and is over a tenth of a second later at most") {
  SupplyRipple ripple = ripple_check;
  std::uint32_t period = 0;
  for (; period < periods_in(0.5f); ++period) {
    const bool found = ripple.detect_ripple(
        counts_of(swing(3.0f, 100.0f)(static_cast<float>(period) * protocol::servo_period_s)), period);
    if (period > periods_in(0.05f)) CHECK(found);
  }
  for (; period < periods_in(0.55f); ++period) ripple.detect_ripple(counts_of(nominal_V), period);
  CHECK(ripple.detect_ripple(counts_of(nominal_V), period));
  for (; period < periods_in(0.601f); ++period) ripple.detect_ripple(counts_of(nominal_V), period);
  CHECK_FALSE(ripple.detect_ripple(counts_of(nominal_V), period));
}

TEST_CASE("skipped readings and a wrapped period counter do not change the result") {
  const auto at_100_Hz = periods_until_ripple(swing(2.0f, 100.0f));
  CHECK(periods_until_ripple(swing(2.0f, 100.0f), 0xFFFF'FF00u) == at_100_Hz);
  CHECK(periods_until_ripple(swing(2.0f, 100.0f), 0, 5) == doctest::Approx(at_100_Hz).epsilon(0.02));
  CHECK(periods_until_ripple(swing(5.0f, 20.0f), 0xFFFF'0000u, 5) == never);
  // The mean follows the supply with a time constant of `within_periods`.
  for (const std::uint32_t every : {1u, 7u}) {
    SupplyRipple ripple = ripple_check;
    ripple.detect_ripple(counts_of(12.0f), 0);
    for (std::uint32_t period = every; period <= SupplyRipple::within_periods; period += every)
      ripple.detect_ripple(counts_of(nominal_V), period);
    const auto mean_counts = static_cast<float>(ripple.mean_counts) / SupplyRipple::mean_periods;
    CHECK(mean_counts * step_V == doctest::Approx(nominal_V - 6.0f / std::numbers::e_v<float>).epsilon(0.01));
  }
}

}  // namespace
