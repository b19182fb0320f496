#include <link/pose_recorder.hpp>

#include <algorithm>

#include <placement/interrupt.hpp>

namespace inkwell::link {

namespace {

using protocol::Signal;

std::uint8_t saturate_to_byte(float value) {
  if (!(value > 0.0f)) return 0;
  return value < 255.0f ? static_cast<std::uint8_t>(value) : std::uint8_t{255};
}

}  // namespace

INKWELL_INTERRUPT void PoseRecorder::record(const protocol::SignalValues& signals, const PeriodSummary& summary) {
  if (longest_was_taken_.load()) {
    longest_was_taken_.store(false);
    longest_cycles_ = 0;
  }
  if (summary.servo_cycles > longest_cycles_) longest_cycles_ = summary.servo_cycles;
  const std::uint32_t written = written_.load();
  Period& period = periods_[written % 2];
  const auto copy_three = [&signals](std::array<float, 3>& target, protocol::EachAxis<Signal> rows) {
    for (std::size_t i = 0; i < 3; ++i) target[i] = signals[rows[i]];
  };
  copy_three(period.position_m, Signal::position_x_m);
  copy_three(period.gimbal_rad, Signal::gimbal_1_rad);
  copy_three(period.force_N, Signal::force_x_N);
  copy_three(period.joint_rad, Signal::joint_1_rad);
  period.supply_V = signals[Signal::supply_V];
  period.longest_cycles = longest_cycles_;
  period.summary = summary;
  written_.store(written + 1);
}

// A copy takes a microsecond and may be interrupted; only if it took two whole control periods is it torn. Three torn
// ones in a row would say that the interrupt leaves the main loop no time; the caller then goes on without.
std::optional<PoseRecorder::Period> PoseRecorder::newest() const {
  constexpr int tries = 3;
  for (int i = 0; i < tries; ++i) {
    const std::uint32_t written = written_.load();
    if (written == 0) return std::nullopt;
    const Period period = periods_[(written - 1) % 2];
    if (written_.load() - written < 2) return period;
  }
  return std::nullopt;
}

bool PoseRecorder::read(protocol::PoseReport& report) const {
  const std::optional<Period> recorded = newest();
  if (!recorded) return false;
  const Period& period = *recorded;
  report.report_id = protocol::ReportId::pose;
  report.state = period.summary.state;
  report.fault = period.summary.fault;
  report.sequence = 0;
  report.time_periods = period.summary.periods;
  std::copy(period.position_m.begin(), period.position_m.end(), report.position_m);
  std::copy(period.gimbal_rad.begin(), period.gimbal_rad.end(), report.gimbal_rad);
  std::copy(period.force_N.begin(), period.force_N.end(), report.force_N);
  std::copy(period.joint_rad.begin(), period.joint_rad.end(), report.joint_rad);
  report.switches = period.summary.switches & 7u;
  report.force_sources = period.summary.force_sources & 7u;
  report.limits = period.summary.limits & 3u;
  report.servo_load = saturate_to_byte(static_cast<float>(period.longest_cycles) * load_per_cycle_);
  report.command_token = period.summary.command_token;
  report.supply_dV = saturate_to_byte(period.supply_V * 10.0f + 0.5f);
  return true;
}

bool PoseRecorder::take(protocol::PoseReport& report) {
  if (!read(report)) return false;
  longest_was_taken_.store(true);
  return true;
}

std::optional<BoardTime> PoseRecorder::time_of(std::uint32_t cycles) const {
  const std::optional<Period> recorded = newest();
  if (!recorded) return std::nullopt;
  const PeriodSummary& latest = recorded->summary;
  const std::uint32_t since = cycles - latest.begin_cycles;
  if (static_cast<std::int32_t>(since) >= 0)
    return BoardTime{latest.periods + since / cycles_per_period_, since % cycles_per_period_};
  const std::uint32_t before = -since;
  const std::uint32_t whole = (before + cycles_per_period_ - 1) / cycles_per_period_;
  return BoardTime{latest.periods - whole, whole * cycles_per_period_ - before};
}

}  // namespace inkwell::link
