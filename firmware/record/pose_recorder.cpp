#include "firmware/record/pose_recorder.hpp"

namespace inkwell::link {

namespace {

using protocol::Signal;

std::uint8_t saturate_to_byte(float value) {
  if (!(value > 0.0f)) return 0;
  return value < 255.0f ? static_cast<std::uint8_t>(value) : std::uint8_t{255};
}

constexpr unsigned known_limits() {
  unsigned bits = 0;
  for (const auto& row : protocol::limit_table) bits |= static_cast<unsigned>(row.limit);
  return bits;
}
constexpr unsigned limits_in_report = 127;
static_assert((known_limits() & ~limits_in_report) == 0, "PoseReport::limits has no room for a limit");

}  // namespace

bool PoseRecorder::read(protocol::PoseReport& report) const {
  const Sample* const sample = samples_.newest();
  if (sample == nullptr) return false;
  const auto& [signals, summary] = *sample;
  report.report_id = protocol::ReportId::pose;
  report.state = summary.state;
  report.fault = summary.fault;
  report.sequence = 0;
  report.time_periods = summary.periods;
  const auto copy_three = [&signals = signals](float(&target)[3], protocol::EachAxis<Signal> rows) {
    for (std::size_t i = 0; i < 3; ++i) target[i] = signals[rows[i]];
  };
  copy_three(report.position_m, Signal::position_x_m);
  copy_three(report.gimbal_rad, Signal::gimbal_1_rad);
  copy_three(report.force_N, Signal::force_x_N);
  copy_three(report.joint_rad, Signal::joint_1_rad);
  report.limits = summary.limits & limits_in_report;
  report.is_referenced = summary.is_referenced;
  report.switches = summary.switches & 7u;
  report.driver_parity = 0;
  report.force_sources = summary.force_sources & 15u;
  report.servo_load = saturate_to_byte(static_cast<float>(longest_cycles_.load()) * load_per_cycle_);
  report.command_token = summary.command_token;
  report.supply_dV = saturate_to_byte(signals[Signal::supply_V] * 10.0f + 0.5f);
  return true;
}

bool PoseRecorder::read_for_report(protocol::PoseReport& report) {
  if (!read(report)) return false;
  note_sent();
  return true;
}

std::uint32_t PoseRecorder::newest_periods() const {
  const Sample* const sample = samples_.newest();
  return sample == nullptr ? 0 : sample->summary.periods;
}

std::optional<std::uint32_t> PoseRecorder::newest_cycles() const {
  const Sample* const sample = samples_.newest();
  return sample == nullptr ? std::nullopt : std::optional(sample->summary.begin_cycles);
}

std::optional<BoardTime> PoseRecorder::time_of(std::uint32_t cycles) const {
  const Sample* const sample = samples_.newest();
  if (sample == nullptr) return std::nullopt;
  const PeriodSummary& latest = sample->summary;
  const std::uint32_t since = cycles - latest.begin_cycles;
  if (static_cast<std::int32_t>(since) >= 0)
    return BoardTime{latest.periods + since / cycles_per_period_, since % cycles_per_period_};
  const std::uint32_t before = -since;
  const std::uint32_t whole = (before + cycles_per_period_ - 1) / cycles_per_period_;
  return BoardTime{latest.periods - whole, whole * cycles_per_period_ - before};
}

}  // namespace inkwell::link
