// The forces of a program arrive in every frame of the host, with low latency.
#include <doctest/doctest.h>

#include <numeric>

#include "protocol/reports.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"
#include "tests/boards/virtual/usb/force_timing.hpp"

namespace inkwell::virtual_usb_test {

TEST_CASE("a force in every frame: none is lost or late, and each is felt within 3 ms of its pose") {
  for (const double host_clock_ppm : {500.0, -500.0}) {
    CAPTURE(host_clock_ppm);
    const ForceTiming timing = measure_forces(flashed_image(), host_clock_ppm, 1.0);
    CHECK(timing.sent >= 998);
    CHECK(timing.received == timing.sent);
    CHECK(timing.lost == 0);
    CHECK(timing.late == 0);
    CHECK(timing.refused == 0);
    CHECK(timing.samples > 19'000);
    CHECK(timing.longest_pose_to_force_periods < 0.003 * protocol::servo_rate_Hz);
    CHECK(std::accumulate(timing.deviations.begin(), timing.deviations.end(), std::uint64_t{0}) + 1 == timing.sent);
  }
}

}  // namespace inkwell::virtual_usb_test
