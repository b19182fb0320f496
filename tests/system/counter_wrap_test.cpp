// The control period counter wraps after 59 hours, and the bus frame counter wraps after 49 days. The wraps must not
// affect the hand or the program. The image near-wrap.elf starts 3 s before the first wrap and 4 s before the second
// wrap.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host/client/device/device.hpp"
#include "host/client/recording/recorder.hpp"
#include "host/client/recording/recording.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::Parameter;
using protocol::Signal;

constexpr std::int64_t wrap = std::int64_t{1} << 32;
constexpr std::int64_t rate_Hz = protocol::servo_rate_Hz;
constexpr std::int64_t periods_per_frame = protocol::servo_rate_Hz / protocol::pose_rate_Hz;
constexpr float program_N = 0.5f;
/// Force tolerance for tremor and sensor noise.
constexpr double force_tolerance_N = 0.05;
constexpr device::Vector3 begin_m = offset_from_free_point(-0.025, 0, 0), end_m = offset_from_free_point(0.025, 0, 0);
/// The hand moves between begin_m and end_m with minimum jerk. The speed is largest at the first wrap, in the middle of
/// the movement.
constexpr double moves_for_s = 1.0, fastest_m_per_s = 1.875 * 0.05 / moves_for_s;
constexpr std::size_t frames_before = 200, frames_after = 100;

/// A hand moves on a plane while a program applies a force. The force is on, and a recording runs.
struct Story {
  std::vector<device::Pose> poses;  ///< since the start of the recording
  recording::Recording recording;
  std::int64_t applied_at_periods = 0;  ///< time of a parameter change after both wraps
  std::optional<device::Driver> driver;
  std::uint32_t forces_refused = 0;
};

void record_until(BoardRig& rig, recording::Recorder& recorder,
                  const std::function<bool(const device::Pose&)>& condition) {
  // Maximum number of slices of 10 ms, in case the test hangs.
  for (int slices = 0; !condition(rig.pose()); ++slices) {
    REQUIRE(slices < 500);
    rig.device->send_force({.force_N = {program_N, 0.0f, 0.0f}, .interval_ms = 10});
    rig.run(0.01);
    while (const auto samples = rig.device->read_scope(0ms)) recorder.push(*samples);
  }
}

Story play() {
  const TemporaryDirectory directory;
  const auto file = directory.file("wrap.h5");
  BoardRig rig(std::string("near-wrap.elf"));
  rig.run_until([](const auto& pose) { return pose.state == protocol::State::ready; });
  rig.take_to(begin_m, 0.3);
  rig.make_active();
  rig.set({{Parameter::program_force_expiry_s, 0.5f}});
  device::Shapes shapes;
  shapes.planes[0] = device::Plane{.point_m = {0.0f, 0.0f, static_cast<float>(free_point_m[2]) + 0.002f},
                                   .normal = {0.0f, 0.0f, 1.0f},
                                   .surface = {.stiffness_N_per_m = 200.0f, .damping_Ns_per_m = 1.0f}};
  rig.device->place_shapes(shapes);
  const double to_wrap_s = device::board_time_s(wrap - rig.pose().time_periods);
  REQUIRE(to_wrap_s > 1.0);
  rig.control.hand_path({{0.0, begin_m}, {to_wrap_s - moves_for_s / 2, begin_m}, {to_wrap_s + moves_for_s / 2, end_m}});
  const std::vector<Signal> signals{Signal::velocity_x_m_s, Signal::force_x_N, Signal::force_sources};
  rig.device->select_signals(signals);
  const std::size_t first_pose = rig.poses().size();
  Story story;
  {
    recording::Recorder recorder(
        file, recording::describe(rig.device->information(), rig.device->parameters(), signals, "", true));
    record_until(rig, recorder, [](const auto& pose) { return pose.sequence > wrap + 150; });
    const device::ParameterChange change{Parameter::wall_stiffness_N_per_m, 555.0f};
    story.applied_at_periods = rig.device->set_parameters({&change, 1}).applied_at_periods;
    record_until(rig, recorder, [](const auto& pose) { return pose.sequence > wrap + 200; });
    const auto status = recorder.stop();
    CHECK(status.error.empty());
    CHECK(status.lost == 0);
  }
  story.poses.assign(rig.poses().begin() + static_cast<std::ptrdiff_t>(first_pose), rig.poses().end());
  story.recording = recording::read(file);
  story.driver = rig.device->driver();
  story.forces_refused = rig.device->information().report.force_reports_refused;
  return story;
}

const Story& story() {
  static const Story first_story = play();
  return first_story;
}

double magnitude_N(const device::Pose& pose) { return std::hypot(pose.force_N[0], pose.force_N[1], pose.force_N[2]); }

/// Returns the first pose after the wrap of this counter. Checks that force, state and time are continuous around the
/// wrap.
const device::Pose& check_goes_on_around(std::int64_t device::Pose::*counter) {
  const auto& poses = story().poses;
  const auto found = std::ranges::find_if(poses, [&](const auto& pose) { return pose.*counter >= wrap; });
  const auto at = static_cast<std::size_t>(found - poses.begin());
  REQUIRE(at >= frames_before);
  REQUIRE(at + frames_after <= poses.size());
  const double before_N = magnitude_N(poses[at - frames_before]);
  CHECK(before_N > 0.8 * program_N);
  for (std::size_t i = at - frames_before + 1; i < at + frames_after; ++i) {
    CAPTURE(i);
    CAPTURE(at);
    REQUIRE(poses[i].sequence == poses[i - 1].sequence + 1);
    REQUIRE(std::abs(poses[i].time_periods - poses[i - 1].time_periods - periods_per_frame) <= 1);
    REQUIRE(protocol::force_is_on(poses[i].state));
    REQUIRE(poses[i].fault == protocol::Fault::none);
    REQUIRE(std::abs(magnitude_N(poses[i]) - before_N) < force_tolerance_N);
  }
  return *found;
}

}  // namespace

TEST_CASE("the count of control periods wraps after 59 hours, and force, speeds and a recording go on") {
  check_goes_on_around(&device::Pose::time_periods);

  const auto& recording = story().recording;
  REQUIRE(recording.size() > static_cast<std::size_t>(rate_Hz));
  CHECK(recording.complete);
  CHECK(recording.lost() == 0);
  CHECK(recording.periods.front() < wrap);
  CHECK(recording.periods.back() == recording.periods.front() + static_cast<std::int64_t>(recording.size()) - 1);
  CHECK(std::ranges::is_sorted(recording.periods));
  // The recording has the same time base as the poses.
  CHECK(std::abs(recording.periods.back() - story().poses.back().time_periods) < rate_Hz / 50);
  CHECK(recording.duration_s() == doctest::Approx(static_cast<double>(recording.size() - 1) / rate_Hz));

  const auto at_wrap = static_cast<std::size_t>(wrap - recording.periods.front());
  const auto& force_x_N = recording.column(Signal::force_x_N);
  const auto& velocity_x_m_s = recording.column(Signal::velocity_x_m_s);
  const auto& force_sources = recording.column(Signal::force_sources);
  for (std::size_t i = at_wrap - 2000; i < at_wrap + 2000; ++i) {
    CAPTURE(static_cast<std::int64_t>(i) - static_cast<std::int64_t>(at_wrap));
    REQUIRE(std::abs(force_x_N[i] - program_N) < force_tolerance_N);
    REQUIRE(std::abs(velocity_x_m_s[i] - fastest_m_per_s) < 0.2 * fastest_m_per_s);
    REQUIRE(force_sources[i] == force_sources[at_wrap - 2000]);
  }
}

TEST_CASE("the count of bus frames wraps after 49 days, and no pose is lost and no force refused") {
  const auto& at_wrap = check_goes_on_around(&device::Pose::sequence);
  CHECK(story().forces_refused == 0);
  CHECK(story().applied_at_periods > at_wrap.time_periods);
  CHECK(story().applied_at_periods < story().poses.back().time_periods);

  // The program is still the driver after the wrap.
  REQUIRE(story().driver);
  CHECK(story().driver->is_this_device);
  const auto& poses = story().poses;
  const double seen_s = device::board_time_s(poses.back().time_periods - poses.front().time_periods);
  CHECK(story().driver->driven_s > seen_s - 1.0);
  CHECK(story().driver->driven_s < seen_s + 2.0);
}

}  // namespace inkwell::tests
