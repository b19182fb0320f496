// When the motors are shorted to brake the arm, and when they are let go.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <limits>

#include <control/brake.hpp>

namespace {

using namespace inkwell;
using control::advance;
using control::Brake;
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
