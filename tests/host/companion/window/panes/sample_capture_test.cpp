// Tests the captured minute: its length, changes of the selection, gaps, and the file.
#include <doctest/doctest.h>

#include <cmath>

#include "host/client/recording/recording.hpp"
#include "host/companion/window/panes/sample_capture.hpp"
#include "protocol/reports.hpp"

#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::window;
using protocol::Signal;

namespace {

device::ScopeSamples samples_of(std::vector<Signal> signals, std::int64_t first_period, std::size_t count,
                                float value) {
  device::ScopeSamples samples{std::move(signals), first_period, count, {}, 0};
  samples.values.assign(count * samples.signals.size(), value);
  return samples;
}

/// Writes the captured samples and returns the recording.
recording::Recording written(const SampleCapture& capture, std::vector<Signal> signals, const std::string& file,
                             std::vector<recording::Mark> marks = {}) {
  recording::Information information;
  information.signals = std::move(signals);
  CHECK(write_captured({file, information, capture.blocks(), std::move(marks)}) == "");
  return recording::read(file);
}

}  // namespace

TEST_CASE("the capture retains the newest 60 seconds") {
  constexpr std::size_t ms_periods = protocol::servo_rate_Hz / 1000;
  SampleCapture capture;
  for (int ms = 0; ms < 75'000; ++ms)
    capture.add(samples_of({Signal::force_N}, 1000 + ms * static_cast<std::int64_t>(ms_periods), ms_periods, 1.0f));
  CHECK(capture.duration_s() == doctest::Approx(SampleCapture::kept_s).epsilon(0.01));
  CHECK(capture.duration_s() >= SampleCapture::kept_s);
  const auto blocks = capture.blocks();
  CHECK(blocks.back()->first_period + static_cast<std::int64_t>(blocks.back()->count) ==
        1000 + 75'000 * static_cast<std::int64_t>(ms_periods));
  CHECK(blocks.size() < 700);  // few enough to copy within a frame
}

TEST_CASE("a saved capture has the samples before and after a change of the selection, and its marks") {
  const tests::TemporaryDirectory directory;
  SampleCapture capture;
  capture.add(samples_of({Signal::force_N, Signal::duty_1}, 5000, 100, 2.0f));
  capture.add(samples_of({Signal::supply_V, Signal::force_N}, 5120, 50, 3.0f));
  const auto recording = written(capture, {Signal::supply_V, Signal::force_N}, directory.file("capture.h5"),
                                 {{5110, "between", device::EventKind::mark, {}}});
  CHECK(recording.complete);
  REQUIRE(recording.size() == 150);
  CHECK(recording.periods.front() == 5000);
  CHECK(recording.lost() == 20);
  CHECK(std::isnan(recording.column(Signal::supply_V)[0]));
  CHECK(recording.column(Signal::supply_V)[100] == 3.0f);
  CHECK(recording.column(Signal::force_N)[0] == 2.0f);
  CHECK(recording.column(Signal::force_N)[149] == 3.0f);
  REQUIRE(recording.marks.size() == 1);
  CHECK(recording.marks[0].text == "between");
}

TEST_CASE("a restart of the board clears the capture, and an existing file is not overwritten") {
  const tests::TemporaryDirectory directory;
  SampleCapture capture;
  capture.add(samples_of({Signal::force_N}, 5000, 100, 2.0f));
  capture.add(samples_of({Signal::force_N}, 100, 50, 3.0f));
  CHECK(written(capture, {Signal::force_N}, directory.file("capture.csv")).size() == 50);
  recording::Information information;
  information.signals = {Signal::force_N};
  CHECK_FALSE(write_captured({directory.file("capture.csv"), information, capture.blocks(), {}}).empty());
}
