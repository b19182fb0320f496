// The pulses of a guide are saved one after the other, with a mark for each pulse.
#include <doctest/doctest.h>

#include <cmath>

#include "host/client/guides/pulse_log.hpp"

#include "tests/temporary_directory.hpp"

using namespace inkwell;
using protocol::Signal;

namespace {

recording::Recording pulse(std::vector<Signal> signals, std::int64_t first_period, float value) {
  auto recording = recording::Recording::without_samples({.signals = std::move(signals)});
  for (int i = 0; i < 50; ++i) {
    recording.periods.push_back(first_period + i);
    for (auto& column : recording.columns) column.push_back(value);
  }
  return recording;
}

}  // namespace

TEST_CASE("a pulse log contains each pulse under its mark, without values of other motors, and is complete") {
  const tests::TemporaryDirectory directory;
  guides::Observation now;
  now.is_simulation = true;
  now.information =
      device::Information{.firmware_version = "0.1.0", .protocol_version = 1, .serial_number = "", .report = {}};
  now.parameters = protocol::default_parameters();
  guides::PulseLog log(directory / "pulses.h5");
  log.add(now, pulse({Signal::duty_1, Signal::current_1_A}, 1000, 0.25f), "motor 1");
  log.add(now, pulse({Signal::current_2_A, Signal::duty_2}, 90'000, 0.5f), "motor 2");

  const auto saved = recording::read(directory / "pulses.h5");
  CHECK(saved.complete);
  CHECK(saved.lost() == 0);
  CHECK(saved.information.simulation);
  REQUIRE(saved.size() == 50 + 200 + 50);
  REQUIRE(saved.marks.size() == 2);
  CHECK(saved.marks[0].text == "motor 1");
  CHECK(saved.marks[0].period == 1000);
  CHECK(saved.marks[1].period == 1250);
  CHECK(saved.column(Signal::current_1_A)[49] == 0.25f);
  CHECK(std::isnan(saved.column(Signal::current_1_A)[50]));
  CHECK(std::isnan(saved.column(Signal::current_2_A)[249]));
  CHECK(saved.column(Signal::current_2_A)[250] == 0.5f);
  CHECK(saved.column(Signal::duty_2)[299] == 0.5f);
  CHECK(std::isnan(saved.column(Signal::supply_V)[299]));

  guides::PulseLog("").add(now, pulse({Signal::duty_1}, 1000, 0.25f), "nothing is saved without a file");
}
