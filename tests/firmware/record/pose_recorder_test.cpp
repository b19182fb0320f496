// Tests the transfer of the newest pose from the control interrupt to the main loop.
#include <doctest/doctest.h>

#include "tests/firmware/link/fresh_link.hpp"

namespace inkwell {

using link::PoseRecorder;
using protocol::PoseReport;
using protocol::Signal;
using test::cycles_per_period;

namespace {

protocol::SignalValues some_signals(float offset = 0.25f) {
  protocol::SignalValues signals{};
  for (std::size_t i = 0; i < protocol::signal_count; ++i) signals.values[i] = static_cast<float>(i) + offset;
  signals[Signal::supply_V] = 18.04f;
  return signals;
}

struct Recorded {
  link::Link& fresh = test::fresh_link();
  bool is_referenced = true;
  PoseRecorder& poses = fresh.poses;

  void record(const protocol::SignalValues& signals, std::uint32_t period, std::uint32_t servo_cycles = 100) {
    test::interrupt(fresh, signals,
                    {.state = protocol::State::ready,
                     .fault = protocol::Fault::none,
                     .switches = 5,
                     .force_sources = 6,
                     .limits = 2,
                     .is_referenced = is_referenced,
                     .command_token = 42,
                     .periods = period,
                     .begin_cycles = period * cycles_per_period});
    poses.note_load(servo_cycles);
  }
};

}  // namespace

TEST_CASE("a report shows the newest period and its signals") {
  Recorded recorded;
  PoseRecorder& recorder = recorded.poses;
  PoseReport report;
  CHECK_FALSE(recorder.read_for_report(report));
  CHECK_FALSE(recorder.read(report));
  for (std::uint32_t period = 1000; period < 1019; ++period) recorded.record(some_signals(0.5f), period);
  recorded.record(some_signals(), 1019);
  REQUIRE(recorder.read_for_report(report));
  CHECK(report.report_id == protocol::ReportId::pose);
  CHECK(report.state == protocol::State::ready);
  CHECK(report.time_periods == 1019);
  const auto equal = [](const float* values, Signal first) {
    for (int i = 0; i < 3; ++i) {
      const float value = values[i];
      CHECK(value == static_cast<float>(static_cast<int>(first) + i) + 0.25f);
    }
  };
  equal(report.position_m, Signal::position_x_m);
  equal(report.gimbal_rad, Signal::gimbal_1_rad);
  equal(report.force_N, Signal::force_x_N);
  equal(report.joint_rad, Signal::joint_1_rad);
  CHECK(int{report.switches} == 5);
  CHECK(int{report.force_sources} == 6);
  CHECK(int{report.limits} == 2);
  CHECK(int{report.is_referenced} == 1);
  CHECK(report.command_token == 42);
  CHECK(report.supply_dV == 180);
  CHECK(report.servo_load == 3);  // 100 of 8400 cycles

  recorded.is_referenced = false;
  recorded.record(some_signals(0.5f), 1020);
  REQUIRE(recorder.read_for_report(report));
  CHECK(report.time_periods == 1020);
  CHECK(int{report.limits} == 2);
  CHECK(int{report.is_referenced} == 0);
  const float position_m = report.position_m[0];
  CHECK(position_m == static_cast<float>(Signal::position_x_m) + 0.5f);
}

TEST_CASE("the load is the longest interrupt since the last report that was taken, and saturates") {
  Recorded recorded;
  PoseRecorder& recorder = recorded.poses;
  const protocol::SignalValues signals = some_signals();
  PoseReport report;
  const auto millisecond = [&](std::uint32_t longest) {
    for (std::uint32_t i = 0; i < 20; ++i) {
      recorded.record(signals, i, i == 7 ? longest : 84u);
      REQUIRE(recorder.read(report));  // read() does not reset the maximum
    }
    REQUIRE(recorder.read_for_report(report));
    return int{report.servo_load};
  };
  CHECK(millisecond(4200) == 127);
  CHECK(millisecond(84) == 2);
  CHECK(millisecond(8400) == 255);
  CHECK(millisecond(100000) == 255);
}

TEST_CASE("a moment of the cycle counter has a board time") {
  Recorded recorded;
  PoseRecorder& recorder = recorded.poses;
  CHECK_FALSE(recorder.time_of(0));          // no period yet
  constexpr std::uint32_t period = 600'000;  // the cycle counter has wrapped
  recorded.record(some_signals(), period);
  for (const std::int32_t cycles : {0, 1, 8399, 8400, 20'000, -1, -8399, -8400, -8401, -168'000}) {
    CAPTURE(cycles);
    const auto time = recorder.time_of(period * cycles_per_period + static_cast<std::uint32_t>(cycles));
    REQUIRE(time);
    CHECK(time->cycles < cycles_per_period);
    const auto periods_since = static_cast<std::int32_t>(time->periods - period);
    CHECK(periods_since * static_cast<std::int32_t>(cycles_per_period) + static_cast<std::int32_t>(time->cycles) ==
          cycles);
  }
}

TEST_CASE("the newest pose is there in each period, also where the count of samples wraps") {
  link::Link& link = test::fresh_link(0xFFFF'FFFE);
  PoseReport report;
  CHECK_FALSE(link.poses.read(report));
  for (std::uint32_t period = 0xFFFF'FFFE; period != 5; ++period) {
    CAPTURE(period);
    test::interrupt(link, some_signals(), {.state = protocol::State::active, .periods = period});
    REQUIRE(link.poses.read(report));
    CHECK(report.time_periods == period);
  }
}

}  // namespace inkwell
