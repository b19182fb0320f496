// Tests lock step: all poses arrive, all forces are in time, and equal seeds produce equal runs.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <inkwell/inkwell.hpp>
#include "tests/dropins/board.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

constexpr double rate_Hz = 20'000;

struct Samples {
  std::vector<float> values;
  std::vector<std::uint32_t> periods;
  bool operator==(const Samples&) const = default;
};

/// Returns one recording of these signals.
Samples record(inkwell_arm* arm, const std::vector<const char*>& signals, std::size_t rows) {
  Samples samples{std::vector<float>(rows * signals.size()), std::vector<std::uint32_t>(rows)};
  REQUIRE(inkwell_select_signals(arm, signals.data(), signals.size()) == INKWELL_OK);
  for (std::size_t done = 0, count = 0; done < rows; done += count) {
    std::uint64_t lost = 0;
    REQUIRE(inkwell_read_scope(arm, 10.0, &samples.values[done * signals.size()], &samples.periods[done], rows - done,
                               &count, &lost) == INKWELL_OK);
    CHECK(lost == 0);
  }
  REQUIRE(inkwell_select_signals(arm, nullptr, 0) == INKWELL_OK);
  return samples;
}

/// Answers each pose with a force along x that is a function of time. Counts the missed poses.
struct TimedServo {
  std::function<double(double time_s)> force_N;
  std::chrono::microseconds takes{0};
  std::atomic<int> calls = 0, missed = 0;
  std::uint32_t sequence = 0;

  static int answer(inkwell_arm*, const inkwell_pose* pose, double force_N[3], void* user) {
    auto& self = *static_cast<TimedServo*>(user);
    if (self.calls++ > 0) self.missed += static_cast<int>(pose->sequence - self.sequence - 1);
    self.sequence = pose->sequence;
    std::this_thread::sleep_for(self.takes);
    force_N[0] = self.force_N(pose->time_s);
    return 0;
  }
};

TEST_CASE("recordings add nothing to the delay from pose to force, and a vibration keeps its size") {
  VirtualArm arm("virtual?seed=3");
  arm.make_active();
  SUBCASE("100 recordings during a servo") {
    constexpr int recordings = 100;
    // Commands replace two force reports at the start of each recording, so the test skips 60 rows.
    constexpr std::size_t displaced = 60, rows = 100;
    constexpr double N_per_s = 0.5;
    inkwell_pose begin;
    REQUIRE(inkwell_get_pose(arm.arm, &begin) == INKWELL_OK);
    const double zero_s = begin.time_s + 0.5;
    TimedServo servo{.force_N = [=](double time_s) { return N_per_s * (time_s - zero_s); }};
    REQUIRE(inkwell_start_servo(arm.arm, &TimedServo::answer, &servo) == INKWELL_OK);
    REQUIRE(inkwell_sleep(arm.arm, 0.02) == INKWELL_OK);
    double shortest = 1e9, longest = 0;
    for (int i = 0; i < recordings; ++i) {
      const Samples samples = record(arm.arm, {"program_force_x_N"}, rows);
      for (std::size_t row = displaced; row < samples.periods.size(); ++row) {
        const double delay = samples.periods[row] - rate_Hz * (samples.values[row] / N_per_s + zero_s);
        shortest = std::min(shortest, delay);
        longest = std::max(longest, delay);
      }
    }
    REQUIRE(inkwell_stop_servo(arm.arm) == INKWELL_OK);
    MESSAGE("simulation: from pose to force ", 1e3 * shortest / rate_Hz, " to ", 1e3 * longest / rate_Hz, " ms");
    CHECK(longest - shortest < 1.0);
    CHECK(longest < 0.0025 * rate_Hz);
    CHECK(servo.missed == 0);
  }
  SUBCASE("200 Hz") {
    constexpr double frequency_Hz = 200, amplitude_N = 0.5;
    TimedServo servo{
        .force_N = [](double time_s) { return amplitude_N * std::sin(2 * std::numbers::pi * frequency_Hz * time_s); }};
    REQUIRE(inkwell_start_servo(arm.arm, &TimedServo::answer, &servo) == INKWELL_OK);
    REQUIRE(inkwell_sleep(arm.arm, 0.02) == INKWELL_OK);
    const Samples samples = record(arm.arm, {"program_force_x_N"}, 2000);
    std::complex<double> part = 0;
    for (std::size_t row = 0; row < samples.periods.size(); ++row)
      part += double{samples.values[row]} *
              std::polar(2.0 / 2000, -2 * std::numbers::pi * frequency_Hz * samples.periods[row] / rate_Hz);
    const double turns = std::numbers::pi * frequency_Hz / 1000, sinc = std::sin(turns) / turns;
    CHECK(std::abs(part) / amplitude_N > 0.97 * sinc * sinc);  // linear interpolation between forces at 1 kHz
  }
}

TEST_CASE("a slow servo misses no pose of a virtual board; a slow loop misses none of an own board") {
  std::string address = "virtual";
  std::optional<Board> board;
  SUBCASE("that was started for it") {}
  SUBCASE("that runs already") {
    board.emplace();
    address = board->address;
  }
  VirtualArm arm(address);
  constexpr std::chrono::milliseconds slow{7};
  TimedServo servo{.force_N = [](double) { return 0.0; }, .takes = slow};
  REQUIRE(inkwell_start_servo(arm.arm, &TimedServo::answer, &servo) == INKWELL_OK);
  arm.wait_until([&](const auto&) { return servo.calls > 40; });
  REQUIRE(inkwell_stop_servo(arm.arm) == INKWELL_OK);
  CHECK(servo.missed == 0);

  const double none_N[3]{};
  inkwell_pose pose, before;
  for (int i = 0; i < 40; ++i) {
    REQUIRE(inkwell_wait_for_pose(arm.arm, 10.0, &pose) == INKWELL_OK);
    // The virtual board waits for a program's forces after the second force.
    if (i > 1 && !board) CHECK(pose.sequence == before.sequence + 1);
    before = pose;
    std::this_thread::sleep_for(slow);
    REQUIRE(inkwell_set_force(arm.arm, none_N) == INKWELL_OK);
  }
}

TEST_CASE("a slow servo in C++ misses no pose of a virtual board, and keeps its claim, which counts board time") {
  inkwell::Arm arm("virtual?seed=2");
  int calls = 0, missed = 0;
  arm.start_servo([&, sequence = std::uint32_t{0}](const inkwell::Pose& pose) mutable {
    if (calls++ > 0) missed += static_cast<int>(pose.sequence - sequence - 1);
    sequence = pose.sequence;
    std::this_thread::sleep_for(std::chrono::milliseconds(calls == 20 ? 1200 : 1));  // longer than claim_expiry_s
    return inkwell::Vector{};
  });
  arm.sleep(0.04);
  CHECK(arm.driver().is_this_arm == 1);
  arm.stop_servo();
  CHECK(calls >= 40);
  CHECK(missed == 0);
}

/// Runs a servo, requests, a moving hand and two recordings. Returns all received values; the newest pose is last.
std::pair<Samples, std::vector<double>> run_script(const std::string& address) {
  VirtualArm arm(address);
  arm.make_active();
  TimedServo servo{.force_N = [](double time_s) { return std::sin(100 * time_s); }};
  REQUIRE(inkwell_start_servo(arm.arm, &TimedServo::answer, &servo) == INKWELL_OK);
  const double beside_m[3]{0.01, 0.0, -0.03};
  REQUIRE(inkwell_move_virtual_hand(arm.arm, beside_m, 300) == INKWELL_OK);
  REQUIRE(inkwell_sleep(arm.arm, 0.05) == INKWELL_OK);
  Samples samples = record(arm.arm, {"position_x_m", "current_1_A", "program_force_x_N"}, 1000);
  const char* const name = "wall_stiffness_N_per_m";
  const double stiffness = 500;
  REQUIRE(inkwell_set_parameters(arm.arm, &name, &stiffness, 1) == INKWELL_OK);
  REQUIRE(inkwell_stop_servo(arm.arm) == INKWELL_OK);
  const Samples second = record(arm.arm, {"position_x_m", "current_1_A", "program_force_x_N"}, 1000);
  samples.values.insert(samples.values.end(), second.values.begin(), second.values.end());
  samples.periods.insert(samples.periods.end(), second.periods.begin(), second.periods.end());
  inkwell_pose pose;
  REQUIRE(inkwell_get_pose(arm.arm, &pose) == INKWELL_OK);
  CHECK(servo.missed == 0);
  return {samples, {pose.time_s, pose.position_m[0], static_cast<double>(servo.calls)}};
}

TEST_CASE("the same program with the same seed gives the same samples, on an idle computer and on a busy one") {
  const auto idle = run_script("virtual?seed=7");
  std::atomic<bool> ends = false;
  std::vector<std::jthread> busy;
  for (int i = 0; i < 2; ++i)
    busy.emplace_back([&] {
      while (!ends) continue;
    });
  const auto loaded = run_script("virtual?seed=7");
  ends = true;
  CHECK(idle == loaded);
  CHECK(run_script("virtual?seed=8").first.values != idle.first.values);  // the noise differs
}

TEST_CASE("the boards of one program have one clock") {
  VirtualArm first, second;
  struct State {
    inkwell_arm* other;
    std::vector<double> ahead_s = {};
    std::atomic<int> calls = 0;
  } state{second.arm};
  const auto compare = [](inkwell_arm*, const inkwell_pose* pose, double*, void* user) {
    auto& self = *static_cast<State*>(user);
    inkwell_pose other;
    if (inkwell_get_pose(self.other, &other) == INKWELL_OK) self.ahead_s.push_back(pose->time_s - other.time_s);
    if (self.calls % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return ++self.calls < 200 ? 0 : 1;
  };
  REQUIRE(inkwell_start_servo(first.arm, compare, &state) == INKWELL_OK);
  first.wait_until([&](const auto&) { return state.calls >= 200; });
  REQUIRE(inkwell_stop_servo(first.arm) == INKWELL_OK);
  REQUIRE(state.ahead_s.size() == 200);
  const auto [least, most] = std::ranges::minmax_element(state.ahead_s);
  CHECK(*most - *least < 0.001);
}

}  // namespace
}  // namespace inkwell::tests
