// The pulses of the self-test: shape, amplitude and duration.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "firmware/control/supervision/self_test_pulses.hpp"

#include "tests/firmware/control/simulated_motors.hpp"

namespace {

using namespace inkwell;
using control::PulseRound;
using control::PulseScale;
using control::PulseSize;
using control::SelfTestPulses;
using control::Triple;

constexpr Triple resistance_ohm{2.0f, 4.0f, 40.0f}, limit_A{2.5f, 0.5f, 2.5f};
constexpr float dead_V = 0.4f;
constexpr PulseScale scale{limit_A, 20.0f, dead_V / 20.0f};

std::vector<Triple> requested_V(SelfTestPulses& pulses, const PulseScale& with) {
  std::vector<Triple> requested;
  pulses.start(PulseSize::of(resistance_ohm));
  while (pulses.runs() && requested.size() < 10'000) requested.push_back(pulses.step({}, {}, with));
  return requested;
}

TEST_CASE("each motor by itself gets low, high, and the same the other way round, a millisecond each") {
  SelfTestPulses pulses;
  CHECK_FALSE(pulses.runs());
  const auto requested = requested_V(pulses, scale);
  REQUIRE(requested.size() == SelfTestPulses::round_periods);
  CHECK(requested.size() < 300);
  // The pulse current is 0.7 A, unless the limit or the voltage is too low.
  const Triple high_V{1.4f + dead_V, 2.0f + dead_V, 7.5f + dead_V};
  const Triple low_V{0.56f + dead_V, 0.8f + dead_V, 3.0f + dead_V};
  for (std::size_t period = 0; period < requested.size(); ++period) {
    CAPTURE(period);
    const std::size_t motor = period / 90, in_motor = period % 90;
    const float wanted_V = in_motor < 20   ? low_V[motor]
                           : in_motor < 40 ? high_V[motor]
                           : in_motor < 60 ? -high_V[motor]
                           : in_motor < 80 ? -low_V[motor]
                                           : 0.0f;
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(requested[period][i] == doctest::Approx(i == motor ? wanted_V : 0.0f).epsilon(1e-5));
  }
}

TEST_CASE("the pulses of a motor with a small resistance last longer, because its time constant is longer") {
  SelfTestPulses pulses;
  const PulseSize size = PulseSize::of({2.0f, 1.0f, 0.1f});
  CHECK(size.level_periods == std::array<std::uint32_t, 3>{20, 40, 60});
  pulses.start(size);
  std::array<int, 3> driven_periods{};
  while (pulses.runs()) {
    const Triple requested_V = pulses.step({}, {}, scale);
    for (std::size_t i = 0; i < 3; ++i) driven_periods[i] += requested_V[i] != 0.0f;
  }
  CHECK(driven_periods == std::array<int, 3>{80, 160, 240});
  CHECK(pulses.round().motors[2].levels_s == doctest::Approx(0.012));
}

TEST_CASE("a motor with a very small current limit gets pulses that are large enough to measure its resistance") {
  constexpr Triple little_for_2_A{2.5f, 0.01f, 2.5f};
  SelfTestPulses pulses;
  float largest_V = 0.0f;
  for (const Triple& requested : requested_V(pulses, {little_for_2_A, 20.0f, dead_V / 20.0f}))
    largest_V = std::max(largest_V, requested[1]);
  CHECK(largest_V == doctest::Approx(0.3f * resistance_ohm[1] + dead_V));
  CHECK(pulses.round().motors[1].takes_part);
}

TEST_CASE("a motor whose current limit is zero gets no pulse and takes no part") {
  constexpr Triple no_room_for_2_A{2.5f, 0.0f, 2.5f};
  SelfTestPulses pulses;
  for (const Triple& requested : requested_V(pulses, {no_room_for_2_A, 20.0f, 0.02f})) CHECK(requested[1] == 0.0f);
  CHECK(pulses.round().motors[0].takes_part);
  CHECK_FALSE(pulses.round().motors[1].takes_part);
  CHECK(pulses.round().motors[2].takes_part);
}

TEST_CASE("the means are of settled currents, of all sensors, and of this round only") {
  SelfTestPulses pulses;
  tests::SimulatedMotors motors;
  for (auto& motor : motors.motors) motor.dead_V = dead_V;
  motors.motors[0].resistance_ohm = 2.0f;
  for (int round = 0; round < 2; ++round) {
    Triple requested_V{};
    pulses.start(PulseSize::of(resistance_ohm));
    while (pulses.runs()) requested_V = pulses.step(motors.step(requested_V), {}, scale);
  }
  const auto& means_A = pulses.round().motors[0].current_A;
  CHECK(means_A[0][0] == doctest::Approx(0.28).epsilon(0.01));
  CHECK(means_A[1][0] == doctest::Approx(0.7).epsilon(0.01));
  CHECK(means_A[2][0] == doctest::Approx(-0.7).epsilon(0.01));
  CHECK(means_A[3][0] == doctest::Approx(-0.28).epsilon(0.01));
  for (const Triple& mean_A : means_A) CHECK(std::fabs(mean_A[1]) + std::fabs(mean_A[2]) < 1e-3f);
}

TEST_CASE("how far its encoder has come is noted for each motor") {
  SelfTestPulses pulses;
  pulses.start(PulseSize::of(resistance_ohm));
  std::int32_t period = 0;
  for (; pulses.runs(); ++period) pulses.step({}, {5 + period, -2 * period, 7}, scale);
  CHECK(pulses.round().motors[0].moved_counts == 79);
  CHECK(pulses.round().motors[1].moved_counts == -2 * 79);
  CHECK(pulses.round().motors[2].moved_counts == 0);
}

TEST_CASE("after a stop, the self-test pulses restart with the first motor") {
  SelfTestPulses pulses;
  pulses.start(PulseSize::of(resistance_ohm));
  for (int i = 0; i < 130; ++i) pulses.step({}, {}, scale);
  pulses.stop();
  CHECK_FALSE(pulses.runs());
  CHECK(requested_V(pulses, scale).size() == SelfTestPulses::round_periods);
}

}  // namespace
