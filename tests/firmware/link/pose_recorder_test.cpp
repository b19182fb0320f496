#include <doctest/doctest.h>

#include <link/pose_recorder.hpp>

namespace inkwell {

using link::PoseRecorder;
using protocol::PoseReport;
using protocol::Signal;

namespace {

protocol::SignalValues some_signals() {
  protocol::SignalValues signals{};
  for (std::size_t i = 0; i < protocol::signal_count; ++i) signals.values[i] = static_cast<float>(i) + 0.25f;
  signals[Signal::supply_V] = 18.04f;
  return signals;
}

void run(PoseRecorder& recorder, std::uint32_t& periods, std::uint32_t reports) {
  const protocol::SignalValues signals = some_signals();
  for (std::uint32_t i = 0; i < reports * PoseRecorder::periods_per_report; ++i)
    recorder.record(signals, {protocol::State::ready, protocol::Fault::none, 5, 42, periods++, 100});
}

}  // namespace

TEST_CASE("a report comes every millisecond and shows the signals of its period") {
  PoseRecorder recorder(8400);
  PoseReport report;
  CHECK_FALSE(recorder.take(report));
  CHECK_FALSE(recorder.newest(report));
  std::uint32_t periods = 1000;
  run(recorder, periods, 1);
  REQUIRE(recorder.take(report));
  CHECK_FALSE(recorder.take(report));
  CHECK(report.report_id == protocol::ReportId::pose);
  CHECK(report.state == protocol::State::ready);
  CHECK(report.sequence == 0);
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
  CHECK(report.switches == 5);
  CHECK(report.command_token == 42);
  CHECK(report.supply_dV == 180);
  CHECK(report.servo_load == 3);  // 100 of 8400 cycles
}

TEST_CASE("the load is the longest interrupt of the millisecond, and saturates") {
  PoseRecorder recorder(8400);
  const protocol::SignalValues signals = some_signals();
  PoseReport report;
  const auto millisecond = [&](std::uint32_t longest) {
    for (std::uint32_t i = 0; i < PoseRecorder::periods_per_report; ++i)
      recorder.record(signals, {protocol::State::ready, protocol::Fault::none, 0, 0, i, i == 7 ? longest : 84u});
    REQUIRE(recorder.take(report));
    return int{report.servo_load};
  };
  CHECK(millisecond(4200) == 127);
  CHECK(millisecond(84) == 2);
  CHECK(millisecond(8400) == 255);
  CHECK(millisecond(100000) == 255);
}

TEST_CASE("reports are taken in order, and what was too late is counted") {
  PoseRecorder recorder(8400);
  std::uint32_t periods = 0;
  PoseReport report;
  run(recorder, periods, 7);
  for (std::uint32_t i = 0; i < 7; ++i) {
    REQUIRE(recorder.take(report));
    CHECK(report.sequence == i);
  }
  CHECK(recorder.dropped() == 0);

  run(recorder, periods, 20);  // 7..26
  for (std::uint32_t i = 20; i < 27; ++i) {
    REQUIRE(recorder.take(report));
    CHECK(report.sequence == i);
  }
  CHECK_FALSE(recorder.take(report));
  CHECK(recorder.dropped() == 13);
  REQUIRE(recorder.newest(report));
  CHECK(report.sequence == 26);
}

TEST_CASE("a host that missed polls once is not late for ever") {
  PoseRecorder recorder(8400);
  std::uint32_t periods = 0;
  PoseReport report;
  run(recorder, periods, 5);  // the hiccup: four too many
  std::uint32_t last = 0;
  for (std::uint32_t i = 0; i < PoseRecorder::patience; ++i) {
    REQUIRE(recorder.take(report));
    CHECK(report.sequence == i);  // for a while everything, in order
    run(recorder, periods, 1);
  }
  for (std::uint32_t i = 0; i < 100; ++i) {
    REQUIRE(recorder.take(report));
    CHECK_FALSE(recorder.take(report));  // nothing newer waits
    CHECK(report.sequence > last);
    last = report.sequence;
    run(recorder, periods, 1);
  }
  CHECK(recorder.dropped() == 4);
}

TEST_CASE("two reports that wait now and then are no lateness") {
  PoseRecorder recorder(8400);
  std::uint32_t periods = 0;
  PoseReport report;
  for (std::uint32_t i = 0; i < 200; ++i) {
    run(recorder, periods, 2);
    REQUIRE(recorder.take(report));
    REQUIRE(recorder.take(report));
  }
  CHECK(recorder.dropped() == 0);
}

TEST_CASE("what waited before a host came is forgotten and not counted") {
  PoseRecorder recorder(8400);
  std::uint32_t periods = 0;
  PoseReport report;
  run(recorder, periods, 50);
  recorder.discard();
  CHECK_FALSE(recorder.take(report));
  run(recorder, periods, 1);
  REQUIRE(recorder.take(report));
  CHECK(report.sequence == 50);
  CHECK(recorder.dropped() == 0);
}

}  // namespace inkwell
