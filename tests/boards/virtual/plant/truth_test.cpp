#include "boards/virtual/plant/truth.hpp"

#include <doctest/doctest.h>

#include "tests/boards/virtual/plant/driven_plant.hpp"

using namespace inkwell::test;

TEST_CASE("a trace returns its rows once and in order, and counts the dropped rows") {
  Trace trace;
  Truth truth{};
  trace.record(0, truth);
  CHECK(trace.read(10).empty());  // not started
  trace.start();
  for (std::uint64_t period = 0; period < 10; ++period) {
    truth.at = period * servo_period;
    truth.position_m = Vector3(0.001 * static_cast<double>(period), 0.0, 0.0);
    truth.supply_V = 17.5;
    trace.record(period, truth);
  }
  trace.stop();
  trace.record(10, truth);
  const auto first = trace.read(4);
  const auto rest = trace.read(100);
  CHECK(first.size() == 4);
  CHECK(rest.size() == 6);
  CHECK(rest.front().period == 4);
  CHECK(rest.front().values.front() == doctest::Approx(0.004));
  CHECK(rest.front().values.back() == 17.5);
  CHECK(trace.read(100).empty());
  CHECK(trace.dropped() == 0);
}
