#include <doctest/doctest.h>

#include "host/client/device/bus_clock.hpp"

using namespace inkwell;

namespace {

device::BusFrame bus_frame(std::int64_t sequence, std::int64_t periods, std::uint32_t cycles) {
  return {.sequence = sequence, .time_periods = periods, .time_cycles = cycles};
}

}  // namespace

TEST_CASE("a control period has a time on the host's clock") {
  device::BusClock clock(8400);
  CHECK_FALSE(clock.host_time_s(5).has_value());
  clock.note(bus_frame(1000, 20'000, 4200));
  CHECK(*clock.host_time_s(20'000) == doctest::Approx(1.0 - 0.000025).epsilon(1e-9));
  CHECK(*clock.host_time_s(20'020) == doctest::Approx(1.001 - 0.000025).epsilon(1e-9));
}

TEST_CASE("the rate is measured, over days too") {
  device::BusClock clock(8400);
  constexpr std::int64_t begin = 1'000, days = 10'000'000'000;
  clock.note(bus_frame(begin, 20 * begin, 0));
  clock.note(bus_frame(begin + days, 20 * begin + 20 * days + days / 100, 0));  // the host is 500 ppm slow
  CHECK(*clock.host_time_s(20 * begin + 20 * days + days / 100) == doctest::Approx(1e-3 * (begin + days)));
  CHECK(*clock.host_time_s(20 * begin + 20 * days + days / 100 + 20'010) ==
        doctest::Approx(1e-3 * (begin + days + 1000)).epsilon(1e-12));
}

TEST_CASE("a bus clock starts a new measurement after the board restarts") {
  device::BusClock clock(8400);
  clock.note(bus_frame(10'000, 200'000, 0));
  clock.note(bus_frame(11'000, 220'020, 0));
  clock.note(bus_frame(5, 3000, 0));
  clock.note(bus_frame(1005, 23'000, 0));
  CHECK(*clock.host_time_s(43'000) == doctest::Approx(2.005).epsilon(1e-9));
}
