// Tests the detection of a dead encoder wire from the counts of the encoder.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "firmware/control/supervision/encoder_wire.hpp"

namespace {

using namespace inkwell;
using control::EncoderWire;
using control::periods_in;

constexpr std::uint32_t never = periods_in(2.0f);

/// Count of a timer in encoder mode if one wire is stuck. The timer counts every second edge, alternately up and down.
std::uint16_t with_dead_wire(std::int64_t count) { return static_cast<std::uint16_t>((count >> 1) & 1); }
std::uint16_t without_dead_wire(std::int64_t count) { return static_cast<std::uint16_t>(count); }

/// Checks `count(time_s)` every `every` periods from `begin` on. Returns the number of periods until the wire is
/// reported as dead.
template <class Count>
std::uint32_t periods_until_dead(Count count, std::uint32_t begin = 0, std::uint32_t every = 1) {
  EncoderWire wire;
  for (std::uint32_t period = 0; period < never; period += every)
    if (wire.detect_dead_wire(count(static_cast<float>(period) * protocol::servo_period_s), begin + period))
      return period;
  return never;
}

auto turning(float counts_per_s, std::uint16_t (*seen)(std::int64_t)) {
  return [=](float time_s) { return seen(std::llround(counts_per_s * time_s)); };
}
/// Alternates between two adjacent 16-bit counts at this rate.
auto dithering(float rate_Hz, std::uint16_t lower = 100) {
  return [=](float time_s) { return static_cast<std::uint16_t>(lower + (std::fmod(time_s * rate_Hz, 1.0f) < 0.5f)); };
}

TEST_CASE("a joint that turns at 1 rad/s with a dead wire is noticed within a tenth of a second, in either direction") {
  constexpr float counts_per_rad = 1440 * 11.2f / 6.2832f;
  for (const float speed_rad_per_s : {1.0f, -1.0f, 3.0f, 10.0f, -23.0f}) {
    CAPTURE(speed_rad_per_s);
    const float counts_per_s = speed_rad_per_s * counts_per_rad;
    CHECK(periods_until_dead(turning(counts_per_s, with_dead_wire)) <= periods_in(0.1f));
    CHECK(periods_until_dead(turning(counts_per_s, without_dead_wire)) == never);
  }
  CHECK(periods_until_dead(turning(0.5f * counts_per_rad, with_dead_wire)) == never);
}

TEST_CASE("a dead wire is detected after a slow motion becomes fast") {
  const auto faster = [](float time_s) { return with_dead_wire(std::llround(2'000.0f * time_s * time_s)); };
  const auto noticed_s = static_cast<float>(periods_until_dead(faster)) * protocol::servo_period_s;
  CHECK(noticed_s > 0.5f);
  CHECK(noticed_s < 0.8f);  // 2400 counts per second at 0.6 s
}

TEST_CASE("the lower neighbour may be the upper one of the timer's range") {
  CHECK(periods_until_dead(dithering(700.0f, 0xFFFF)) < periods_in(0.1f));
  CHECK(periods_until_dead(dithering(700.0f, 0x7FFF)) < periods_in(0.1f));
}

TEST_CASE("an edge that is crossed to and fro 500 times a second is no dead wire, 650 times is one") {
  for (const float rate_Hz : {10.0f, 41.0f, 300.0f, 500.0f, 590.0f}) {
    CAPTURE(rate_Hz);
    CHECK(periods_until_dead(dithering(rate_Hz)) == never);
  }
  CHECK(periods_until_dead(dithering(650.0f)) < periods_in(0.1f));
}

TEST_CASE("an oscillation by two or more counts does not indicate a dead encoder wire, at any rate") {
  const auto buzz = [](float amplitude_counts, float rate_Hz) {
    return [=](float time_s) {
      return static_cast<std::uint16_t>(
          1000 + std::lround(amplitude_counts * std::sin(2.0f * std::numbers::pi_v<float> * rate_Hz * time_s)));
    };
  };
  CHECK(periods_until_dead(buzz(1.0f, 2'000.0f)) == never);
  CHECK(periods_until_dead(buzz(10.0f, 200.0f)) == never);
  const auto by_two = [](float time_s) {
    return static_cast<std::uint16_t>(std::fmod(time_s * 2'000.0f, 1.0f) < 0.5f ? 100 : 102);
  };
  CHECK(periods_until_dead(by_two) == never);
}

TEST_CASE("an encoder dither that moves on by a count restarts the check of the wire") {
  const auto creeping = [](float time_s) {
    return static_cast<std::uint16_t>(std::lround(25.0f * time_s) + (std::fmod(time_s * 900.0f, 1.0f) < 0.5f));
  };
  CHECK(periods_until_dead(creeping) == never);  // 40 ms on each pair
}

TEST_CASE("a dead wire is detected repeatedly while the count alternates, and no longer once the count is stationary") {
  EncoderWire wire;
  int found = 0;
  std::uint32_t period = 0;
  for (; period < periods_in(0.601f); ++period)
    found += wire.detect_dead_wire(dithering(1'000.0f)(static_cast<float>(period) * protocol::servo_period_s), period);
  CHECK(found == 10);  // 120 changes in 60 ms
  const std::uint16_t last = wire.count;
  for (; period < periods_in(0.8f); ++period) CHECK_FALSE(wire.detect_dead_wire(last, period));
}

TEST_CASE("skipped readings and a wrapped period counter do not change the result") {
  const auto turns = turning(4'000.0f, with_dead_wire);
  CHECK(periods_until_dead(turns, 0xFFFF'FF00u) == periods_until_dead(turns));
  CHECK(periods_until_dead(turns, 0, 3) == doctest::Approx(periods_until_dead(turns)).epsilon(0.02));
}

}  // namespace
