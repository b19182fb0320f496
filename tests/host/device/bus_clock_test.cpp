#include <doctest/doctest.h>

#include <device/bus_clock.hpp>

using namespace inkwell;

namespace {

protocol::FrameReport report(std::uint32_t sequence, std::uint32_t periods, std::uint32_t cycles) {
  protocol::FrameReport report{};
  report.sequence = sequence;
  report.time_periods = periods;
  report.time_cycles = cycles;
  return report;
}

}  // namespace

TEST_CASE("a control period has a time on the host's clock") {
  device::BusClock clock(8400);
  CHECK_FALSE(clock.host_time_s(5).has_value());
  clock.note(report(1000, 20'000, 4200));
  CHECK(*clock.host_time_s(20'000) == doctest::Approx(1.0 - 0.000025).epsilon(1e-9));
  CHECK(*clock.host_time_s(20'020) == doctest::Approx(1.001 - 0.000025).epsilon(1e-9));
}

TEST_CASE("the rate is measured, over a wrap of the counts too") {
  device::BusClock clock(8400);
  clock.note(report(0xFFFF'FF00, 0xFFFF'F000, 0));
  clock.note(report(0xFFFF'FF00 + 2000, 0xFFFF'F000 + 40'020, 0));  // the host is 500 ppm slow
  CHECK(*clock.host_time_s(0xFFFF'F000 + 40'020) == doctest::Approx((2000 - 256) / 1000.0));
  CHECK(*clock.host_time_s(0xFFFF'F000 + 60'030) == doctest::Approx((3000 - 256) / 1000.0).epsilon(1e-9));
}

TEST_CASE("a board that started again is measured anew") {
  device::BusClock clock(8400);
  clock.note(report(10'000, 200'000, 0));
  clock.note(report(11'000, 220'020, 0));
  clock.note(report(5, 3000, 0));
  clock.note(report(1005, 23'000, 0));
  CHECK(*clock.host_time_s(43'000) == doctest::Approx(2.005).epsilon(1e-9));
}
