// Tests how the brake short-circuits the motors, and how it is released.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "firmware/control/settings.hpp"
#include "firmware/control/supervision/brake.hpp"
#include "tests/firmware/control/arms.hpp"

namespace {

using namespace inkwell;
using control::Brake;
using protocol::condition;
using protocol::Fault;

constexpr float fast = 0.5f * 0.5f, slow = 0.05f * 0.05f;

Brake begun(protocol::Conditions found) {
  Brake brake;
  brake.begin();
  brake.advance(fast, found);
  return brake;
}

TEST_CASE("an arm that is let loose while it moves is braked until it is slow, and not again") {
  Brake brake = begun(condition(Fault::over_speed));
  CHECK(brake.is_on());
  for (int i = 0; i < 100; ++i) brake.advance(fast, {});
  CHECK(brake.is_on());
  brake.advance(slow, {});
  CHECK_FALSE(brake.is_on());
  brake.advance(fast, {});
  CHECK_FALSE(brake.is_on());
}

TEST_CASE("one that is slow coasts") {
  Brake brake;
  brake.begin();
  brake.advance(slow, condition(Fault::host_silent));
  CHECK_FALSE(brake.is_on());
  brake.begin();
  brake.advance(std::numeric_limits<float>::quiet_NaN(), condition(Fault::host_silent));
  CHECK_FALSE(brake.is_on());
}

TEST_CASE("half a second is the longest") {
  Brake brake = begun(condition(Fault::over_speed));
  int periods = 0;
  for (; brake.is_on() && periods < 100'000; ++periods) brake.advance(fast, condition(Fault::over_speed));
  CHECK(periods >= 9'990);
  CHECK(periods <= 10'000);
}

TEST_CASE("a motor that resists with more than the force limit lets all go, of a gentle brake with a part of it") {
  constexpr control::Triple limit_A{1.0f, 2.0f, 3.0f};
  for (const Fault fault : {Fault::over_speed, Fault::force_law, Fault::host_silent, Fault::usb_gone}) {
    const float part = fault == Fault::host_silent || fault == Fault::usb_gone ? Brake::gentle_part : 1.0f;
    const Brake brake = begun(condition(fault));
    CHECK(brake.shorts({part * 0.999f, part * -1.999f, part * 2.999f}, limit_A));
    CHECK_FALSE(brake.shorts({part * -1.001f, 0.0f, 0.0f}, limit_A));
    CHECK_FALSE(brake.shorts({0.0f, part * 2.001f, 0.0f}, limit_A));
    CHECK_FALSE(brake.shorts({0.0f, 0.0f, part * -3.001f}, limit_A));
    CHECK_FALSE(brake.shorts({0.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f}, limit_A));
    Brake over = brake;
    over.advance(slow, condition(fault));
    CHECK_FALSE(over.shorts({}, limit_A));
  }
  CHECK_FALSE(Brake{}.shorts({}, limit_A));
}

TEST_CASE("the brake is gentle after the host was silent, until the next brake begins") {
  constexpr control::Triple limit_A{1.0f, 1.0f, 1.0f}, resists_A{0.5f, -0.5f, 0.5f};
  Brake brake = begun(condition(Fault::over_speed));
  CHECK(brake.shorts(resists_A, limit_A));
  brake.advance(fast, condition(Fault::host_silent));
  CHECK_FALSE(brake.shorts(resists_A, limit_A));
  brake.advance(fast, {});
  CHECK_FALSE(brake.shorts(resists_A, limit_A));
  brake.begin();
  CHECK(brake.shorts(resists_A, limit_A));
  // If the host was silent before the probe became too fast, the hand causes the speed and the brake is gentle.
  Brake silent = begun(condition(Fault::host_silent));
  silent.advance(fast, condition(Fault::over_speed));
  CHECK_FALSE(silent.shorts(resists_A, limit_A));
}

TEST_CASE("the limit is that of the force at the end of the longer link, by each motor's constant and gear") {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::omni_parameters();
  set[force_limit_N] = 2.0f;
  set[link_3_m] = 0.2f;
  set[torque_constant_2_Nm_per_A] = 0.05f;
  set[motor_3_reversed] = 1.0f;
  const auto settings = control::prepare(set);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(settings.limits.brake_A[i] == doctest::Approx(2.0f * 0.2f * std::fabs(settings.motors.ampere_per_Nm[i])));
}

TEST_CASE("the brake starts only after faults that leave bridges, currents and speeds reliable") {
  const std::array braked{Fault::over_speed, Fault::usb_gone, Fault::host_silent, Fault::force_law};
  for (const Fault fault : braked) CHECK(begun(condition(fault)).is_on());
  for (const auto& row : protocol::fault_table) {
    const auto fault = static_cast<Fault>(row.code);
    if (fault == Fault::none || std::ranges::find(braked, fault) != braked.end()) continue;
    CAPTURE(row.name);
    CHECK_FALSE(begun(condition(fault)).is_on());
    CHECK_FALSE(begun(condition(fault) | condition(Fault::over_speed)).is_on());
    Brake brake = begun(condition(Fault::over_speed));
    brake.advance(fast, condition(fault));
    CHECK_FALSE(brake.is_on());
  }
}

}  // namespace
