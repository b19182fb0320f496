// Tests the detection of a stuck encoder. Normal motions must not be reported as a stuck encoder.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/control/settings.hpp"
#include "firmware/control/supervision/stuck_encoder.hpp"
#include "tests/firmware/control/arms.hpp"

namespace {

using namespace inkwell;
using control::StuckEncoder;

constexpr float moving_A = 1.0f;
constexpr int readings_per_s = static_cast<int>(protocol::servo_rate_Hz) / 3;

/// Checks `counts(time_s)` and `current_A(time_s)` for one second.
template <class Counts, class Current>
bool is_detected(Counts counts, Current current_A, bool held = false, std::int32_t begin = 0) {
  StuckEncoder encoder{.counts = begin};
  for (int reading = 0; reading < readings_per_s; ++reading) {
    const float time_s = static_cast<float>(reading) / readings_per_s;
    const auto now_periods = static_cast<std::uint32_t>(3 * reading);
    if (encoder.detect_stuck_encoder(counts(time_s), current_A(time_s), now_periods, held, moving_A)) return true;
  }
  return false;
}

/// The returned current changes to these values one after another; each change takes 0.15 s.
template <std::size_t size>
auto through(const std::array<float, size>& currents_A) {
  return [=](float time_s) {
    float current_A = currents_A[0];
    for (std::size_t i = 1; i < size; ++i) {
      const float part = std::clamp((time_s - 0.2f) / 0.15f - static_cast<float>(i - 1), 0.0f, 1.0f);
      current_A += part * (currents_A[i] - currents_A[i - 1]);
    }
    return current_A;
  };
}
/// Returns a current with a linear change between 0.2 and 0.7 s.
auto rising(float from_A, float to_A) {
  return [=](float time_s) { return from_A + (to_A - from_A) * std::clamp(2.0f * time_s - 0.4f, 0.0f, 1.0f); };
}
std::int32_t stationary(float) { return 4711; }

TEST_CASE(
    "an encoder is stuck if it is stationary while the current changes by three times the limit, in either direction") {
  CHECK_FALSE(is_detected(stationary, rising(0.3f, 3.25f)));
  CHECK(is_detected(stationary, rising(0.3f, 3.36f)));
  CHECK_FALSE(is_detected(stationary, rising(0.3f, -2.65f)));
  CHECK(is_detected(stationary, rising(0.3f, -2.76f)));
}

TEST_CASE("two large current changes do not detect a stuck encoder, and the third change does, in either direction") {
  CHECK_FALSE(is_detected(stationary, through(std::array{0.0f, 1.2f})));
  CHECK_FALSE(is_detected(stationary, through(std::array{0.0f, 1.2f, 0.0f})));
  CHECK(is_detected(stationary, through(std::array{0.0f, 1.2f, 0.0f, 1.2f})));
  CHECK(is_detected(stationary, through(std::array{1.2f, 0.0f, 1.2f, 0.0f})));
  CHECK_FALSE(is_detected(stationary, through(std::array{0.0f, 0.9f, 0.0f, 0.9f, 0.0f})));
}

TEST_CASE("current changes before the last encoder movement do not count towards a stuck encoder") {
  // The current rises from 0 to 5.8 A, and the encoder moves by two counts in the middle of the rise.
  const auto stepping = [](float time_s) { return time_s < 0.45f ? 100 : 102; };
  CHECK(is_detected(stationary, rising(0.0f, 5.8f)));
  CHECK_FALSE(is_detected(stepping, rising(0.0f, 5.8f)));
  const auto back = [](float time_s) { return time_s < 0.45f ? 100 : 98; };
  CHECK_FALSE(is_detected(back, rising(0.0f, 5.8f)));
}

TEST_CASE("the current change that moves a joint does not count towards a stuck encoder at the new angle") {
  // The joint moves during the first current change and is stationary during two later changes.
  const auto current_A = [](int reading) {
    if (reading >= 3'500) return reading < 5'000 ? 0.0f : 0.8f;
    return 0.8f * std::clamp(static_cast<float>(reading - 2'000) / 400.0f, 0.0f, 1.0f);
  };
  int detected = 0;
  for (int reading_of_step = 2'300; reading_of_step < 2'600; ++reading_of_step) {
    StuckEncoder encoder{.counts = 100};
    for (int reading = 0; reading < 6'000; ++reading)
      detected += encoder.detect_stuck_encoder(reading < reading_of_step ? 100 : 102, current_A(reading),
                                               static_cast<std::uint32_t>(3 * reading), false, 0.7f);
  }
  CHECK(detected == 0);
}

TEST_CASE("a reversing arm is stuck only if it is stationary for too long during a current change") {
  // The joint stops at 0.2 s, when the current starts to rise by 8 A. The joint reverses within the allowed time in the
  // first run and too late in the second run.
  for (const float stationary_s : {0.09f, 0.2f}) {
    const auto turning_round = [=](float time_s) {
      return time_s < 0.2f ? static_cast<std::int32_t>(1e4f * time_s)
                           : 2'000 - static_cast<std::int32_t>(1e4f * std::max(0.0f, time_s - 0.2f - stationary_s));
    };
    const auto current_A = [](float time_s) { return 4.0f * std::clamp(10.0f * (time_s - 0.2f), 0.0f, 2.0f); };
    CHECK(is_detected(turning_round, current_A) == (stationary_s > 0.1f));
  }
}

TEST_CASE("a count to and fro is not motion: one wire may be dead") {
  const auto dithering = [](float time_s) { return 100 + static_cast<std::int32_t>(40.0f * time_s) % 2; };
  CHECK(is_detected(dithering, rising(0.0f, 3.2f), false, 100));
  const auto below = [](float time_s) { return 100 - static_cast<std::int32_t>(40.0f * time_s) % 2; };
  CHECK(is_detected(below, rising(0.0f, 3.2f), false, 100));
}

TEST_CASE("a current that turns round faster than an arm can follow leaves no trace, one that lasts does") {
  const auto square = [](float rate_Hz) {
    return [=](float time_s) { return std::fmod(time_s * rate_Hz, 1.0f) < 0.5f ? 2.5f : -2.5f; };
  };
  CHECK_FALSE(is_detected(stationary, square(400.0f)));
  CHECK(is_detected(stationary, square(10.0f)));
}

TEST_CASE("while the arm is held, current changes do not count, and earlier changes are discarded") {
  CHECK_FALSE(is_detected(stationary, rising(0.0f, 8.0f), true));
  StuckEncoder encoder;
  std::uint32_t now_periods = 0;
  const auto reading = [&](float current_A, bool held) {
    for (int i = 0; i < 1'000; ++i)
      CHECK_FALSE(encoder.detect_stuck_encoder(7, current_A, now_periods += 3, held, moving_A));
  };
  reading(0.0f, false);
  reading(2.5f, false);
  reading(2.5f, true);
  reading(0.0f, false);
  reading(2.5f, false);
}

TEST_CASE("moving_A of each motor produces 1.5 N at the end of the longer link") {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::omni_parameters();
  set[link_3_m] = 0.2f;
  set[torque_constant_2_Nm_per_A] = 0.05f;
  set[motor_3_reversed] = 1.0f;
  const auto settings = control::prepare(set);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(settings.limits.moving_A[i] == doctest::Approx(0.3f * std::fabs(settings.motors.ampere_per_Nm[i])));
}

}  // namespace
