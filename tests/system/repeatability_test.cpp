// Tests that the same seed and the same calls produce the same run in both modes.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/system/board_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;
using protocol::Signal;

namespace {

/// Recorded results of a run.
struct Story {
  std::vector<std::string> poses;
  std::vector<float> samples;
  std::vector<double> truth;
  std::uint64_t instructions = 0;
};

/// Returns the bytes of the members without padding. NaN represents an unknown position and is equal to NaN in this
/// comparison.
std::string bytes_of(const device::Pose& pose) {
  std::string bytes;
  const auto append = [&](const auto&... members) {
    (bytes.append(reinterpret_cast<const char*>(&members), sizeof members), ...);
  };
  append(pose.state, pose.fault, pose.limits, pose.is_referenced, pose.sequence, pose.time_periods, pose.position_m,
         pose.gimbal_rad, pose.force_N, pose.joint_rad, pose.switches, pose.driver_parity, pose.force_sources,
         pose.servo_load, pose.command_token, pose.supply_dV);
  return bytes;
}

constexpr std::size_t story_signals = 5;

/// Takes a stylus out of the inkwell and presses it into a wall. `dawdling`: delays of the host between its calls.
template <class Dawdling>
Story play(device::SimulationMode mode, std::uint64_t seed, Dawdling dawdling) {
  BoardRig rig(mode, seed);
  dawdling();
  rig.make_active();
  dawdling();
  rig.command(protocol::Command::heartbeat);
  dawdling();
  rig.device->select_signals(std::array<Signal, story_signals>{
      Signal::encoder_1_counts, Signal::velocity_z_m_s, Signal::current_2_A, Signal::duty_3, Signal::servo_cycles});
  dawdling();
  rig.control.trace_start();
  rig.take_to(free_point_m, 0.2);
  dawdling();
  rig.set({{protocol::Parameter::box_minimum_z_m, -0.02f}});
  dawdling();
  rig.run(0.05);
  rig.command(protocol::Command::disable_force);
  dawdling();
  rig.run(0.05);

  Story story;
  while (const auto frame = rig.device->read_scope(0ms))
    story.samples.insert(story.samples.end(), frame->values.begin(), frame->values.end());
  for (const auto& pose : rig.poses()) story.poses.push_back(bytes_of(pose));
  story.truth = rig.control.trace_read(100'000).values;
  story.instructions = rig.control.status().all.at("instructions");
  return story;
}

const Story& prompt_story(device::SimulationMode mode) {
  static std::map<device::SimulationMode, Story> stories;
  if (!stories.contains(mode)) stories[mode] = play(mode, 3, [] {});
  return stories[mode];
}

void check_repeats(device::SimulationMode mode) {
  const auto& prompt = prompt_story(mode);
  REQUIRE(prompt.samples.size() > story_signals * 10'000);
  const auto slow = play(mode, 3, [call = 0]() mutable { std::this_thread::sleep_for(7ms * (++call % 4)); });
  CHECK(prompt.instructions == slow.instructions);
  CHECK((prompt.poses == slow.poses));
  CHECK((prompt.samples == slow.samples));
  CHECK((prompt.truth == slow.truth));
}

struct Cycles {
  double mean, longest;
};

/// Mean and maximum of the control interrupt's cycles. This signal is the last signal in each recorded sample.
Cycles servo_cycles(const Story& story) {
  double sum = 0, longest = 0;
  std::size_t count = 0;
  for (std::size_t i = story_signals - 1; i < story.samples.size(); i += story_signals, ++count) {
    sum += story.samples[i];
    longest = std::max(longest, static_cast<double>(story.samples[i]));
  }
  return {sum / static_cast<double>(count), longest};
}

}  // namespace

TEST_CASE("a run begins with all that the host sent and ends with all that the device sent") {
  BoardRig rig;
  rig.control.run(0.0001);  // each run then ends just after the report of a frame, the most critical case
  int late_reports = 0;
  std::set<int> delays;  // delay of the commands, in runs
  for (int round = 0; round < 1000; ++round) {
    const int token = rig.device->send(protocol::Command::heartbeat);
    rig.control.run(0.001);
    const auto pose = rig.device->read_pose(0ms);
    late_reports += !pose;
    if (pose && round > 10) delays.insert((token - pose->command_token + 255) % 255);
  }
  CHECK(late_reports == 0);
  CHECK(delays.size() == 1);
}

TEST_CASE("fast mode repeats itself") { check_repeats(device::SimulationMode::fast); }
TEST_CASE("exact mode repeats itself") { check_repeats(device::SimulationMode::exact); }
TEST_CASE("another seed is another run") {
  CHECK(prompt_story(device::SimulationMode::fast).samples != play(device::SimulationMode::fast, 4, [] {}).samples);
}

TEST_CASE("both modes count the same cycles within 2 %") {
  const auto exact = servo_cycles(prompt_story(device::SimulationMode::exact));
  const auto fast = servo_cycles(prompt_story(device::SimulationMode::fast));
  MESSAGE("simulation: the control interrupt takes ", exact.mean, " cycles on average in exact mode, ", fast.mean,
          " in fast mode; at most ", exact.longest, " and ", fast.longest);
  CHECK(exact.mean > 500);
  CHECK(fast.mean == doctest::Approx(exact.mean).epsilon(0.02));
  CHECK(fast.longest == doctest::Approx(exact.longest).epsilon(0.02));
}
