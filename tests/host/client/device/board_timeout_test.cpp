// Tests time limits in board time.
#include <doctest/doctest.h>

#include <chrono>
#include <optional>

#include "host/client/device/board_timeout.hpp"

using namespace inkwell;
using namespace std::chrono_literals;

TEST_CASE("a time-out counts board time, even if the computer is slow") {
  device::BoardTimeout limit(1.0, 2s);
  const std::chrono::steady_clock::time_point begin{};
  CHECK_FALSE(limit.update_time(5'000, begin));
  CHECK_FALSE(limit.update_time(10'000, begin + 1900ms));
  CHECK_FALSE(limit.update_time(25'000, begin + 3800ms));
  CHECK(limit.update_time(25'001, begin + 3900ms));
}

TEST_CASE("wall time counts while board time does not pass") {
  device::BoardTimeout limit(1.0, 2s);
  const std::chrono::steady_clock::time_point begin{};
  std::optional<std::int64_t> now_periods;
  SUBCASE("no pose has arrived") {}
  SUBCASE("because the board is paused") { now_periods = 100; }
  CHECK_FALSE(limit.update_time(now_periods, begin));
  CHECK_FALSE(limit.update_time(now_periods, begin + 2s));
  CHECK(limit.update_time(now_periods, begin + 2001ms));
  CHECK_FALSE(limit.update_time(101, begin + 3s));  // board time advances again
}
