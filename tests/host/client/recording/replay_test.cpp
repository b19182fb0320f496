// A replay returns the recorded samples once, in order and at the requested speed.
#include <doctest/doctest.h>

#include <algorithm>

#include "host/client/device/error.hpp"
#include "host/client/recording/replay.hpp"
#include "host/client/recording/signals.hpp"

using namespace inkwell;
using namespace inkwell::recording;
using protocol::Signal;
using protocol::SimulatedQuantity;

namespace {

/// Every value is the sample's control period plus a thousandth of the signal's list position.
Recording recorded(std::vector<Signal> signals,
                   std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> stretches) {
  Recording recording;
  recording.information.signals = std::move(signals);
  recording.columns.resize(recording.information.signals.size());
  for (const auto& [first, count] : stretches)
    for (std::uint32_t period = first; period < first + count; ++period) {
      recording.periods.push_back(period);
      for (std::size_t j = 0; j < recording.columns.size(); ++j)
        recording.columns[j].push_back(static_cast<float>(period) + 0.001f * static_cast<float>(j));
    }
  return recording;
}

std::size_t count_of(const Replay::Passed& passed) {
  std::size_t count = 0;
  for (const auto& block : passed.blocks) count += block.count;
  return count;
}

}  // namespace

TEST_CASE("a replay returns every sample once, in order, and stops at the end") {
  Replay replay(recorded({Signal::force_N, Signal::duty_1}, {{1000, 20'001}}));
  CHECK(replay.duration_s() == doctest::Approx(1.0));
  CHECK(count_of(replay.advance(0.5, 1)) == 1);  // stays at its first sample
  CHECK(replay.position_s() == 0);
  replay.play();
  std::uint32_t expected_period = 1001;
  double passed_s = 0;
  for (; replay.is_playing(); passed_s += 1.0 / 60) {
    REQUIRE(passed_s < 2);
    for (const auto& block : replay.advance(1.0 / 60, 1).blocks) {
      CHECK(block.first_period == expected_period);
      CHECK(block.lost_before == 0);
      REQUIRE(block.values.size() == 2 * block.count);
      CHECK(block.values[0] == static_cast<float>(expected_period));
      CHECK(block.values[1] == static_cast<float>(expected_period) + 0.001f);
      expected_period += static_cast<std::uint32_t>(block.count);
    }
  }
  CHECK(expected_period == 21'001);
  CHECK(passed_s == doctest::Approx(1.0).epsilon(0.02));
  CHECK(replay.position_s() == doctest::Approx(1.0));
  replay.play();  // from the start again
  const auto again = replay.advance(0.0, 1);
  CHECK(again.is_restart);
  CHECK(again.blocks.front().first_period == 1000);
}

TEST_CASE("the speed of a replay is kept, and bounded") {
  Replay replay(recorded({Signal::force_N}, {{0, 20'001}}));
  replay.advance(0, 0);
  replay.play();
  replay.set_speed(0.1);
  CHECK(count_of(replay.advance(0.5, 0)) == 1000);
  replay.set_speed(2);
  CHECK(count_of(replay.advance(0.1, 0)) == 4000);
  replay.pause();
  CHECK(count_of(replay.advance(10, 0)) == 0);
  replay.set_speed(1e9);
  CHECK(replay.speed() == Replay::speed_maximum);
  replay.set_speed(-1);
  CHECK(replay.speed() == Replay::speed_minimum);
}

TEST_CASE("after a seek, the replay returns the samples before the new position") {
  Replay replay(recorded({Signal::force_N}, {{500, 20'001}}));
  CHECK(replay.advance(0, 0.1).is_restart);
  CHECK_FALSE(replay.advance(0, 0.1).is_restart);
  replay.seek(0.5);
  auto passed = replay.advance(0, 0.1);
  CHECK(passed.is_restart);
  CHECK(passed.blocks.front().first_period == 500 + 8000);
  CHECK(passed.blocks.front().lost_before == 0);
  CHECK(count_of(passed) == 2001);
  replay.seek(99);
  CHECK(replay.position_s() == doctest::Approx(1.0));
  CHECK(count_of(replay.advance(0, 99)) == 20'001);
  replay.seek(-1);
  CHECK(replay.position_s() == 0);
}

TEST_CASE("a replay returns the selected signals, also of samples that were already replayed") {
  Replay replay(recorded({Signal::force_N, Signal::duty_1, Signal::supply_V}, {{100, 10'000}, {10'200, 10'000}}));
  CHECK_FALSE(replay.select({Signal::supply_V, Signal::force_N, Signal::duty_1}));
  CHECK(replay.select({Signal::supply_V, Signal::duty_2}));
  replay.seek(0.6);
  const auto passed = replay.advance(0, 0.2);
  REQUIRE_FALSE(passed.blocks.empty());
  CHECK(passed.blocks.front().signals == std::vector{Signal::supply_V});
  CHECK(passed.blocks.front().values.at(0) == 8100.0f + 0.002f);
  CHECK(replay.select({Signal::force_N, Signal::supply_V}));
  const auto again = replay.between(10'090, 10'210);
  REQUIRE(again.size() == 2);
  CHECK(again[0].first_period == 10'090);
  CHECK(again[0].count == 10);
  CHECK(again[1].first_period == 10'200);
  CHECK(again[1].lost_before == 100);
  CHECK(again[1].count == 10);
  CHECK(again[1].values.size() == 20);
  CHECK(count_of(replay.advance(0, 0.2)) == 0);
  CHECK(replay.select({}));  // at least one signal, because a block without signals has no samples
  CHECK(replay.signals().size() == 1);
}

TEST_CASE("a gap of the recording is a gap of the replay") {
  Replay replay(recorded({Signal::force_N}, {{100, 10}, {130, 10}}));
  replay.play();
  const auto passed = replay.advance(1, 0);
  REQUIRE(passed.blocks.size() == 2);
  CHECK(passed.blocks[0].count == 10);
  CHECK(passed.blocks[1].first_period == 130);
  CHECK(passed.blocks[1].lost_before == 20);
}

TEST_CASE("the pose at a position is the recorded pose at this time") {
  Replay replay(recorded(standard_signals(), {{2000, 1001}}));
  replay.seek(0.02);  // 400 control periods
  const auto pose = replay.pose();
  REQUIRE(pose);
  CHECK(pose->time_periods == 2400);
  const auto fraction_of = [](Signal signal) {
    const auto signals = standard_signals();
    return 0.001f * static_cast<float>(std::find(signals.begin(), signals.end(), signal) - signals.begin());
  };
  CHECK(pose->joint_rad[1] == 2400.0f + fraction_of(Signal::joint_2_rad));
  CHECK(pose->position_m[2] == 2400.0f + fraction_of(Signal::position_z_m));
  CHECK(pose->force_N[0] == 2400.0f + fraction_of(Signal::force_x_N));
  CHECK(pose->gimbal_rad[2] == 2400.0f + fraction_of(Signal::gimbal_3_rad));
  CHECK(pose->state == protocol::State::active);
  CHECK(int{pose->is_referenced} == 1);

  auto without_force = recorded(standard_signals(), {{2000, 10}});
  for (std::size_t j = 0; j < without_force.columns.size(); ++j)
    if (words_of(without_force.information.signals[j]) == "force") without_force.columns[j].assign(10, 0.0f);
  CHECK(Replay(without_force).pose()->state == protocol::State::ready);
  CHECK_FALSE(Replay(recorded({Signal::force_N}, {{0, 1}})).pose());
}

TEST_CASE("a replay omits the simulated quantities of its recording") {
  auto recording = recorded({Signal::force_N}, {{100, 10}});
  recording.information.simulated = {SimulatedQuantity::true_current_1_A};
  recording.simulated_columns = {std::vector<float>(10, 7.0f)};
  Replay replay(recording);
  replay.play();
  const auto passed = replay.advance(1, 0);
  REQUIRE(passed.blocks.size() == 1);
  CHECK(passed.blocks[0].signals == std::vector{Signal::force_N});
  CHECK(passed.blocks[0].values.size() == 10);
}

TEST_CASE("nothing can be replayed from an empty recording") {
  CHECK_THROWS_AS(Replay(recorded({Signal::force_N}, {})), device::Error);
}

TEST_CASE("signals are chosen by name") {
  CHECK(parse_signals("force_N,duty_1,force_N") == std::vector{Signal::force_N, Signal::duty_1});
  try {
    parse_signals("force_N,positon_x_m");
    FAIL("a misspelt name was taken");
  } catch (const device::Error& error) {
    CHECK(std::string(error.what()).find("position_x_m") != std::string::npos);
  }
  CHECK_THROWS_AS(parse_signals(""), device::Error);
  std::string all;
  for (const auto& row : protocol::signal_table) all += std::string(row.name) + ",";
  CHECK(parse_signals(all).size() == protocol::signal_count);
  CHECK(signal_path().size() == 31);
  CHECK(standard_signals().size() <= protocol::scope_signals_maximum);
  CHECK(words_of(Signal::current_reference_2_A) == "current reference");
  CHECK(words_of(Signal::velocity_x_m_s) == "velocity");
  CHECK(words_of(Signal::force_N) == "force");
  CHECK(words_of(Signal::duty_3) == "duty");
  CHECK(words_of(SimulatedQuantity::true_current_3_A) == "true current");
  CHECK(parse_quantities("force_N,true_current_3_A,force_N") ==
        std::vector<Quantity>{Signal::force_N, SimulatedQuantity::true_current_3_A});
  CHECK_THROWS_AS(parse_quantities("true_curent_3_A"), device::Error);
  CHECK_THROWS_AS(parse_signals("true_current_3_A"), device::Error);  // no board can record this quantity
}
