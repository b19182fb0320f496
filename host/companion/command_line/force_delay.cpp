#include "host/companion/command_line/force_delay.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "host/companion/command_line/force_switch.hpp"
#include "host/companion/command_line/next_pose.hpp"

namespace inkwell::command_line {
namespace {

using namespace std::chrono_literals;
using device::Pose;
using device::ScopeSamples;
using protocol::Signal;

constexpr double rate_Hz = protocol::servo_rate_Hz;
constexpr double periods_per_ms = rate_Hz / 1000;
constexpr std::int64_t periods_in(double seconds) { return static_cast<std::int64_t>(seconds * rate_Hz); }
/// The evaluation ignores the samples of this settling time at the start of each recording and vibration.
constexpr std::int64_t settling_periods = periods_in(0.02);
constexpr std::int64_t ramp_periods = periods_in(0.06), vibration_periods = periods_in(0.2);
/// Waiting time for the last samples of a vibration.
constexpr std::int64_t sample_delay_periods = periods_in(0.01);

/// Answers each pose with a force along x, and reads the scope between poses.
class Program {
 public:
  /// Returns the force in newtons for a control period.
  using Law = std::function<double(std::int64_t period)>;
  using Read = std::function<void(const ScopeSamples&)>;

  explicit Program(device::Device& device) : device_(device) {}

  /// Answers poses for `periods` control periods.
  void run(std::int64_t periods, const Law& law, const Read& read) {
    Pose pose = next();
    for (const std::int64_t begin = pose.time_periods; pose.time_periods - begin < periods; pose = next()) {
      if (!protocol::force_is_on(pose.state)) throw device::Error(force_sentence(pose));
      if (sequence_ && pose.sequence != *sequence_ + 1) poses_missed_ += pose.sequence - *sequence_ - 1;
      sequence_ = pose.sequence;
      answer(pose, law(pose.time_periods));
      while (const auto samples = device_.read_scope(0ms)) read(*samples);
    }
    answer(pose, law(pose.time_periods));
  }

  /// Poses that are missed during the selection are not counted.
  void select(const std::vector<Signal>& signals) {
    device_.select_signals(signals);
    sequence_.reset();
  }

  std::int64_t now() { return next().time_periods; }
  std::int64_t poses_missed() const { return poses_missed_; }

 private:
  /// Returns the newest pose and discards older poses.
  Pose next() {
    Pose pose = next_pose(device_);
    while (const auto newer = device_.read_pose(0ms)) pose = *newer;
    return pose;
  }

  void answer(const Pose& pose, double force_N) {
    if (!device_.wait_until_written(0ms)) return;  // a command occupies this bus frame
    device_.send_force({.force_N = {static_cast<float>(force_N), 0, 0},
                        .mode = protocol::ForceMode::instead_of_walls,
                        .pose_sequence = static_cast<std::uint32_t>(pose.sequence)});
  }

  device::Device& device_;
  std::optional<std::int64_t> sequence_;
  std::int64_t poses_missed_ = 0;
};

/// The force rises linearly, so each force value occurs in only one control period.
ForceDelay::Recording record_ramp(Program& program) {
  program.select({Signal::program_force_x_N});
  const std::int64_t begin = program.now();
  const double N_per_period = 2.0 * delay_force_N / static_cast<double>(ramp_periods);
  const auto law = [&](std::int64_t period) {
    return std::min(N_per_period * static_cast<double>(period - begin), 2.0 * delay_force_N) - delay_force_N;
  };
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  program.run(ramp_periods, law, [&](const ScopeSamples& samples) {
    for (std::size_t i = 0; i < samples.count; ++i) {
      const std::int64_t passed = samples.first_period + static_cast<std::int64_t>(i) - begin;
      if (passed < settling_periods || passed >= ramp_periods) continue;
      const double delay = static_cast<double>(passed) - (samples.values[i] + delay_force_N) / N_per_period;
      shortest = std::min(shortest, delay);
      longest = std::max(longest, delay);
    }
  });
  program.select({});
  if (longest == 0) throw device::Error("The board sent no samples. Reset the board and try again.");
  return {shortest / periods_per_ms, longest / periods_per_ms};
}

/// Sine force with phase 0 in period 0.
class Sine {
 public:
  explicit Sine(double frequency_Hz) : frequency_Hz_(frequency_Hz) {}
  double operator()(std::int64_t period) const { return delay_force_N * std::sin(angle(period)); }
  /// Returns `value` times the complex phasor of the sine.
  std::complex<double> part(std::int64_t period, double value) const {
    return value * std::complex<double>(std::sin(angle(period)), std::cos(angle(period)));
  }
  Transmission transmission(std::complex<double> from, std::complex<double> to) const {
    const std::complex<double> ratio = to / from;
    const double turns = -std::arg(ratio) / (2 * std::numbers::pi);
    constexpr double rounding = 1e-3;  // a delay is not negative
    return {std::abs(ratio), 1e3 * (turns < -rounding ? turns + 1 : turns) / frequency_Hz_};
  }

 private:
  double angle(std::int64_t period) const {
    const double turns = static_cast<double>(period) * (frequency_Hz_ / rate_Hz);
    return 2 * std::numbers::pi * (turns - std::floor(turns));
  }
  double frequency_Hz_;
};

Response vibrate(Program& program, double frequency_Hz) {
  const std::vector<Signal> signals{Signal::program_force_x_N, Signal::current_reference_1_A, Signal::current_1_A};
  program.select(signals);
  const Sine sine(frequency_Hz);
  const std::int64_t begin = program.now() + settling_periods;
  std::complex<double> computed = 0, force = 0, reference = 0, current = 0;
  program.run(settling_periods + vibration_periods + sample_delay_periods, sine, [&](const ScopeSamples& samples) {
    for (std::size_t i = 0; i < samples.count; ++i) {
      const std::int64_t period = samples.first_period + static_cast<std::int64_t>(i);
      if (period < begin || period >= begin + vibration_periods) continue;
      const float* const row = &samples.values[i * signals.size()];
      computed += sine.part(period, sine(period));
      force += sine.part(period, row[0]);
      reference += sine.part(period, row[1]);
      current += sine.part(period, row[2]);
    }
  });
  program.select({});
  return {frequency_Hz, sine.transmission(computed, force), sine.transmission(reference, current)};
}

}  // namespace

ForceDelay measure_force_delay(device::Device& device, int recordings, const std::vector<double>& frequencies_Hz) {
  Program program(device);
  ForceDelay measured;
  for (int i = 0; i < recordings; ++i) measured.recordings.push_back(record_ramp(program));
  for (const double frequency_Hz : frequencies_Hz) measured.responses.push_back(vibrate(program, frequency_Hz));
  measured.poses_missed = program.poses_missed();
  return measured;
}

}  // namespace inkwell::command_line
