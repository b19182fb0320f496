// Pose reports, one a millisecond, from the control interrupt to the main loop.
#pragma once

#include <array>
#include <cstdint>

#include <link/shared.hpp>
#include <protocol/reports.hpp>
#include <protocol/signals.hpp>

namespace inkwell::link {

/// What one control period leaves behind beside its signals.
struct PeriodSummary {
  protocol::State state;
  protocol::Fault fault;
  std::uint8_t switches;       ///< bits of protocol::Switch
  std::uint8_t command_token;  ///< CommandQueue::last_token()
  std::uint32_t periods;       ///< number of this control period
  std::uint32_t servo_cycles;  ///< longest known so far: of this interrupt or of the one before it
};

/// Ring that the interrupt always writes; the main loop follows and counts what it was too late for.
///
/// A host that missed some polls gets what waited. But it polls once a millisecond and a report comes once a
/// millisecond, so it would never catch up, and all later poses would be as late as the hiccup was long. What still
/// waits after `patience` reports is therefore dropped: a pose is worth more new than complete, and the scope is
/// there for whoever wants every period.
class PoseRecorder {
 public:
  static constexpr std::uint32_t periods_per_report = protocol::servo_rate_Hz / protocol::pose_rate_Hz;
  static constexpr std::uint32_t capacity = 8;
  static constexpr std::uint32_t patience = 32;

  /// `cycles_per_period`: processor cycles of one control period, for PoseReport::servo_load.
  explicit PoseRecorder(std::uint32_t cycles_per_period)
      : load_per_cycle_(255.0f / static_cast<float>(cycles_per_period)) {}

  // ---- control interrupt ----

  /// Called every period; writes a report every periods_per_report.
  void record(const protocol::SignalValues& signals, const PeriodSummary& summary) {
    if (summary.servo_cycles > longest_cycles_) longest_cycles_ = summary.servo_cycles;
    if (--countdown_ == 0) write(signals, summary);
  }

  // ---- main loop ----

  /// The oldest report that was not taken yet; false if there is none.
  bool take(protocol::PoseReport& report);

  /// The newest report, whether taken or not; false before the first one.
  bool newest(protocol::PoseReport& report) const;

  /// Forgets what waits, without counting it: nobody was there to read it.
  void discard() {
    taken_ = written_.load();
    behind_ = 0;
  }

  /// Reports that the main loop could not pass on in time.
  std::uint32_t dropped() const { return dropped_; }

 private:
  void write(const protocol::SignalValues& signals, const PeriodSummary& summary);
  void skip_to(std::uint32_t sequence);

  std::array<protocol::PoseReport, capacity> reports_{};
  Shared<std::uint32_t> written_{0};  ///< written by the interrupt
  std::uint32_t taken_ = 0;           ///< the main loop's
  std::uint32_t dropped_ = 0;         ///< the main loop's
  std::uint32_t behind_ = 0;          ///< the main loop's: reports taken since none but the newest waited
  std::uint32_t countdown_ = periods_per_report;
  std::uint32_t longest_cycles_ = 0;
  float load_per_cycle_;
};

}  // namespace inkwell::link
