#include "host/client/recording/replay.hpp"

#include <algorithm>

#include "host/client/device/error.hpp"

namespace inkwell::recording {
namespace {

using protocol::Signal;

constexpr std::size_t block_samples_maximum = 4096;
constexpr double half_period_s = 0.5 / protocol::servo_rate_Hz;

}  // namespace

Replay::Replay(StoredRecording recording) : recording_(std::move(recording)), signals_(recording_.information.signals) {
  if (recording_.size() == 0) throw device::Error("The recording contains no samples, so there is nothing to replay.");
  for (std::size_t i = 0; i < recording_.information.signals.size(); ++i)
    columns_[static_cast<std::size_t>(recording_.information.signals[i])] = i;
}

void Replay::play() {
  if (position_s_ >= duration_s()) seek(0);
  is_playing_ = true;
}

void Replay::seek(double position_s) {
  position_s_ = std::clamp(position_s, 0.0, duration_s());
  was_moved_ = true;
}

bool Replay::select(const std::vector<Signal>& shown) {
  auto selected = recorded_of(recording_.information.signals, shown);
  // A block without signals would have no samples.
  if (selected.empty() && !recording_.information.signals.empty())
    selected.push_back(recording_.information.signals.front());
  if (selected == signals_) return false;
  signals_ = std::move(selected);
  return true;
}

void Replay::set_speed(double speed) { speed_ = std::clamp(speed, speed_minimum, speed_maximum); }

Replay::Passed Replay::advance(double passed_s, double history_s) {
  Passed passed{.is_restart = std::exchange(was_moved_, false), .blocks = {}};
  if (passed.is_restart) next_sample_ = recording_.sample_at(position_s_ - history_s);
  if (is_playing_) position_s_ = std::min(duration_s(), position_s_ + speed_ * std::max(0.0, passed_s));
  if (position_s_ >= duration_s()) is_playing_ = false;

  const std::size_t end = recording_.sample_at(position_s_ + half_period_s);
  add_blocks(passed.blocks, next_sample_, end);
  next_sample_ = std::max(next_sample_, end);
  if (passed.is_restart && !passed.blocks.empty()) passed.blocks.front().lost_before = 0;
  return passed;
}

void Replay::add_blocks(std::vector<device::ScopeSamples>& blocks, std::size_t begin, std::size_t end) const {
  for (; recording_.information.step_periods > 1 && begin < end; ++begin)
    blocks.push_back(recording_.held_sample(begin, signals_));
  while (begin < end) {
    const std::size_t last = recording_.end_of_stretch(begin, std::min(end, begin + block_samples_maximum));
    blocks.push_back(recording_.samples(begin, last, signals_));
    begin = last;
  }
}

std::vector<device::ScopeSamples> Replay::between(std::int64_t first_period, std::int64_t end_period) const {
  const auto sample_at = [this](std::int64_t period) {
    return recording_.sample_at(device::board_time_s(period - recording_.first_period()));
  };
  std::vector<device::ScopeSamples> blocks;
  add_blocks(blocks, sample_at(first_period), sample_at(end_period));
  return blocks;
}

std::optional<std::size_t> Replay::column_of(Signal signal) const { return columns_[static_cast<std::size_t>(signal)]; }

std::size_t Replay::present_sample() const {
  const std::size_t after = recording_.sample_at(position_s_ + half_period_s);
  return after == 0 ? 0 : after - 1;
}

std::optional<device::Pose> Replay::pose() const {
  if (!column_of(Signal::joint_1_rad) || !column_of(Signal::joint_2_rad) || !column_of(Signal::joint_3_rad))
    return std::nullopt;
  const std::size_t present = present_sample();
  const auto value = [&](Signal signal) {
    const auto column = column_of(signal);
    return column ? recording_.value(*column, present) : 0.0f;
  };
  device::Pose pose{};
  pose.time_periods = recording_.period(present);
  pose.sequence = pose.time_periods / (protocol::servo_rate_Hz / protocol::pose_rate_Hz);
  const auto vector = [&](float(&to)[3], protocol::EachAxis<Signal> rows) {
    for (std::size_t i = 0; i < 3; ++i) to[i] = value(rows[i]);
  };
  vector(pose.joint_rad, Signal::joint_1_rad);
  vector(pose.position_m, Signal::position_x_m);
  vector(pose.gimbal_rad, Signal::gimbal_1_rad);
  vector(pose.force_N, Signal::force_x_N);
  const bool pushes =
      std::any_of(std::begin(pose.force_N), std::end(pose.force_N), [](float force_N) { return force_N != 0.0f; });
  pose.state = pushes ? protocol::State::active : protocol::State::ready;
  pose.fault = protocol::Fault::none;
  pose.is_referenced = true;  // not recorded; the arm is drawn from its joint angles
  const float supply_dV = std::clamp(10.0f * value(Signal::supply_V), 0.0f, 255.0f);
  pose.supply_dV = static_cast<std::uint8_t>(supply_dV);
  return pose;
}

}  // namespace inkwell::recording
