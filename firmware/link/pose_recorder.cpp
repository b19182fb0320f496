#include <link/pose_recorder.hpp>

#include <placement/interrupt.hpp>

namespace inkwell::link {

namespace {

using protocol::Signal;

std::uint8_t saturate_to_byte(float value) {
  if (!(value > 0.0f)) return 0;
  return value < 255.0f ? static_cast<std::uint8_t>(value) : std::uint8_t{255};
}

}  // namespace

INKWELL_INTERRUPT void PoseRecorder::write(const protocol::SignalValues& signals, const PeriodSummary& summary) {
  const std::uint32_t written = written_.load();
  protocol::PoseReport& report = reports_[written % capacity];
  report.report_id = protocol::ReportId::pose;
  report.state = summary.state;
  report.fault = summary.fault;
  report.sequence = written;
  report.time_periods = summary.periods;
  const auto copy_three = [&signals](float* target, protocol::EachAxis<Signal> rows) {
    for (std::size_t i = 0; i < 3; ++i) target[i] = signals[rows[i]];
  };
  copy_three(report.position_m, Signal::position_x_m);
  copy_three(report.gimbal_rad, Signal::gimbal_1_rad);
  copy_three(report.force_N, Signal::force_x_N);
  copy_three(report.joint_rad, Signal::joint_1_rad);
  report.switches = summary.switches;
  report.servo_load = saturate_to_byte(static_cast<float>(longest_cycles_) * load_per_cycle_);
  report.command_token = summary.command_token;
  report.supply_dV = saturate_to_byte(signals[Signal::supply_V] * 10.0f + 0.5f);

  countdown_ = periods_per_report;
  longest_cycles_ = 0;
  written_.store(written + 1);
}

bool PoseRecorder::take(protocol::PoseReport& report) {
  const std::uint32_t written = written_.load();
  if (written == taken_) return false;
  // One place stays unread, for the report that the interrupt may write while this one is copied; a copy
  // takes far less than the millisecond between two reports.
  constexpr std::uint32_t readable = capacity - 1;
  const std::uint32_t waiting = written - taken_;
  behind_ = waiting > 1 ? behind_ + 1 : 0;
  if (behind_ > patience) {
    skip_to(written - 1);
    behind_ = 0;
  } else if (waiting > readable) {
    skip_to(written - readable);
  }
  report = reports_[taken_ % capacity];
  ++taken_;
  return true;
}

void PoseRecorder::skip_to(std::uint32_t sequence) {
  dropped_ += sequence - taken_;
  taken_ = sequence;
}

bool PoseRecorder::newest(protocol::PoseReport& report) const {
  const std::uint32_t written = written_.load();
  if (written == 0) return false;
  // Safe without a second look: the interrupt comes round to this place after capacity - 1 milliseconds.
  report = reports_[(written - 1) % capacity];
  return true;
}

}  // namespace inkwell::link
