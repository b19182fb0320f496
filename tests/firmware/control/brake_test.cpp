// When the motors are shorted to brake the arm, and when they are let go.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <control/brake.hpp>
#include <control/settings.hpp>
#include <firmware/control/arms.hpp>

namespace {

using namespace inkwell;
using control::advance;
using control::Brake;
using control::shorts;
using protocol::Fault;
using protocol::watch;

constexpr float fast = 0.5f * 0.5f, slow = 0.05f * 0.05f;

Brake begun(protocol::Watches found) {
  Brake brake;
  brake.begin();
  advance(brake, fast, found);
  return brake;
}

TEST_CASE("an arm that is let loose while it moves is braked until it is slow, and not again") {
  Brake brake = begun(watch(Fault::over_speed));
  CHECK(brake.is_on());
  for (int i = 0; i < 100; ++i) advance(brake, fast, 0);
  CHECK(brake.is_on());
  advance(brake, slow, 0);
  CHECK_FALSE(brake.is_on());
  advance(brake, fast, 0);
  CHECK_FALSE(brake.is_on());
}

TEST_CASE("one that is slow coasts") {
  Brake brake;
  brake.begin();
  advance(brake, slow, watch(Fault::host_silent));
  CHECK_FALSE(brake.is_on());
  brake.begin();
  advance(brake, std::numeric_limits<float>::quiet_NaN(), watch(Fault::host_silent));
  CHECK_FALSE(brake.is_on());
}

TEST_CASE("half a second is the longest") {
  Brake brake = begun(watch(Fault::over_speed));
  int periods = 0;
  for (; brake.is_on() && periods < 100'000; ++periods) advance(brake, fast, watch(Fault::over_speed));
  CHECK(periods >= 9'990);
  CHECK(periods <= 10'000);
}

TEST_CASE("a hand that the host has left alone is braked gently: a motor that resists with more lets all go") {
  constexpr control::Triple gentle_A{0.1f, 0.2f, 0.3f};
  const Brake brake = begun(watch(Fault::host_silent));
  CHECK(shorts(brake, {0.1f, -0.2f, 0.3f}, gentle_A));
  CHECK_FALSE(shorts(brake, {-0.101f, 0.0f, 0.0f}, gentle_A));
  CHECK_FALSE(shorts(brake, {0.0f, 0.201f, 0.0f}, gentle_A));
  CHECK_FALSE(shorts(brake, {0.0f, 0.0f, -0.301f}, gentle_A));
  CHECK_FALSE(shorts(brake, {0.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f}, gentle_A));
  CHECK_FALSE(shorts(Brake{}, {}, gentle_A));
  Brake over = brake;
  advance(over, slow, watch(Fault::host_silent));
  CHECK_FALSE(shorts(over, {}, gentle_A));
}

TEST_CASE("an arm that is too fast is braked with all that its motors have, unless the host fell silent as well") {
  constexpr control::Triple gentle_A{0.1f, 0.1f, 0.1f}, large_A{2.0f, -2.0f, 2.0f};
  CHECK(shorts(begun(watch(Fault::over_speed)), large_A, gentle_A));
  CHECK(shorts(begun(watch(Fault::force_law)), large_A, gentle_A));
  Brake brake = begun(watch(Fault::over_speed));
  advance(brake, fast, watch(Fault::host_silent));
  CHECK_FALSE(shorts(brake, large_A, gentle_A));
  advance(brake, fast, 0);
  CHECK_FALSE(shorts(brake, large_A, gentle_A));
  brake.begin();
  CHECK(shorts(brake, large_A, gentle_A));
  // Also the other way round: it is the hand that makes it fast.
  Brake silent = begun(watch(Fault::host_silent));
  advance(silent, fast, watch(Fault::over_speed));
  CHECK_FALSE(shorts(silent, large_A, gentle_A));
}

TEST_CASE("gentle is a part of the force limit at the end of the longer link, by each motor's constant and gear") {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::omni_parameters();
  set[force_limit_N] = 2.0f;
  set[link_3_m] = 0.2f;
  set[torque_constant_2_Nm_per_A] = 0.05f;
  set[motor_3_reversed] = 1.0f;
  const auto settings = control::prepare(set);
  const float gentle_Nm = 2.0f * Brake::gentle_part_of_force_limit * 0.2f;
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(settings.limits.gentle_brake_A[i] ==
          doctest::Approx(gentle_Nm * std::fabs(settings.motors.ampere_per_Nm[i])));
}

TEST_CASE("only after the faults that leave bridges, currents and speeds to be trusted, alone or beside others") {
  const std::array braked{Fault::over_speed, Fault::host_silent, Fault::force_law};
  for (const Fault fault : braked) CHECK(begun(watch(fault)).is_on());
  for (const auto& row : protocol::fault_table) {
    const auto fault = static_cast<Fault>(row.code);
    if (fault == Fault::none || std::ranges::find(braked, fault) != braked.end()) continue;
    CAPTURE(row.name);
    CHECK_FALSE(begun(watch(fault)).is_on());
    CHECK_FALSE(begun(watch(fault) | watch(Fault::over_speed)).is_on());
    Brake brake = begun(watch(Fault::over_speed));
    advance(brake, fast, watch(fault));
    CHECK_FALSE(brake.is_on());
  }
}

}  // namespace
