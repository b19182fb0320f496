#include <doctest/doctest.h>

#include <cstdint>

#include "host/client/guides/pulse_recorder.hpp"

using namespace inkwell;
using guides::PulseRecorder;
using protocol::Signal;

namespace {

struct CountingPort final : guides::DevicePort {
  void send(protocol::Command) override {}
  void send(protocol::Command, const protocol::TestPulse&) override { ++pulses; }
  void set_parameters(std::vector<device::ParameterChange>) override {}
  void select_signals(std::vector<Signal>) override {}
  int pulses = 0;
};

struct Scope {
  explicit Scope(PulseRecorder& the_recorder) : recorder(the_recorder) {}
  void shows(float value, std::size_t count) {
    recorder.receive({{Signal::duty_1}, period, count, std::vector<float>(count, value), lost});
    period += static_cast<std::uint32_t>(count);
    lost = 0;
  }
  void loses(std::uint32_t samples) {
    period += samples;
    lost = samples;
  }
  PulseRecorder& recorder;
  std::uint32_t period = 1000;
  std::uint64_t lost = 0;
};

}  // namespace

TEST_CASE("a pulse whose samples were lost is made again when the one before is over, and recorded from its begin") {
  protocol::TestPulse pulse{};
  pulse.duration_s = 0.005f;  // 100 periods
  PulseRecorder recorder(protocol::Command::test_voltage, pulse, {Signal::duty_1}, Signal::duty_1);
  CountingPort port;
  device::Pose pose{};
  pose.state = protocol::State::ready;
  recorder.begin(pose, port);
  Scope scope(recorder);
  scope.shows(0.0f, 60);
  CHECK_FALSE(recorder.advance(pose, port));
  CHECK(port.pulses == 1);
  scope.shows(1.0f, 20);
  scope.loses(5);
  scope.shows(1.0f, 10);
  CHECK_FALSE(recorder.advance(pose, port));
  scope.shows(1.0f, 60);
  CHECK_FALSE(recorder.advance(pose, port));
  CHECK(port.pulses == 1);
  scope.shows(0.0f, 99);  // the rest of the first pulse, during which the board accepts no other pulse
  CHECK_FALSE(recorder.advance(pose, port));
  CHECK(port.pulses == 1);
  scope.shows(0.0f, 5);
  CHECK_FALSE(recorder.advance(pose, port));
  CHECK(port.pulses == 2);
  scope.shows(0.0f, 5);
  scope.shows(1.0f, 100);
  scope.shows(0.0f, 110);
  CHECK(recorder.advance(pose, port));
  const auto& column = recorder.column(Signal::duty_1);
  REQUIRE(column.size() == 40 + 200);
  CHECK(column[39] == 0.0f);
  CHECK(column[40] == 1.0f);
  CHECK(column[139] == 1.0f);
  CHECK(column[140] == 0.0f);
}
