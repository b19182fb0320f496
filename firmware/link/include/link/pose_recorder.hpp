// The newest pose, from the control interrupt to the main loop.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <link/shared.hpp>
#include <protocol/reports.hpp>
#include <protocol/signals.hpp>

namespace inkwell::link {

/// What one control period leaves behind beside its signals.
struct PeriodSummary {
  protocol::State state;
  protocol::Fault fault;
  std::uint8_t switches;       ///< bits of protocol::Switch
  std::uint8_t force_sources;  ///< bits of protocol::ForceSource
  std::uint8_t limits;         ///< bits of protocol::Limit
  std::uint8_t command_token;  ///< CommandQueue::last_token()
  std::uint32_t periods;       ///< number of this control period
  std::uint32_t begin_cycles;  ///< the cycle counter at its begin
  std::uint32_t servo_cycles;  ///< longest known so far: of this interrupt or of the one before it
};

/// Board time of a moment.
struct BoardTime {
  std::uint32_t periods;  ///< the control period it lies in
  std::uint32_t cycles;   ///< processor cycles since the begin of that period
};

/// The interrupt leaves what a report is made of in two places in turn; the main loop makes a report of it when the bus
/// wants one. While it copies one place, the interrupt writes the other.
class PoseRecorder {
 public:
  explicit PoseRecorder(std::uint32_t cycles_per_period)
      : cycles_per_period_(cycles_per_period), load_per_cycle_(255.0f / static_cast<float>(cycles_per_period)) {}

  // ---- control interrupt ----

  /// Called every period.
  void record(const protocol::SignalValues& signals, const PeriodSummary& summary);

  // ---- main loop ----

  /// The newest pose, without a sequence; false if there is none: before the first period, or if it was overwritten
  /// during each of three tries to copy it.
  bool read(protocol::PoseReport& report) const;

  /// The same for a report that is sent: the longest interrupt is looked for anew.
  bool take(protocol::PoseReport& report);

  /// Board time at a moment of the cycle counter that is less than 12 s ago; nothing if there is no pose to count from.
  std::optional<BoardTime> time_of(std::uint32_t cycles) const;

 private:
  struct Period {
    std::array<float, 3> position_m, gimbal_rad, force_N, joint_rad;
    float supply_V;
    std::uint32_t longest_cycles;
    PeriodSummary summary;
  };
  std::optional<Period> newest() const;

  std::array<Period, 2> periods_{};
  Shared<std::uint32_t> written_{0};       ///< written by the interrupt
  Shared<bool> longest_was_taken_{false};  ///< set by the main loop, cleared by the interrupt
  std::uint32_t longest_cycles_ = 0;       ///< the interrupt's
  std::uint32_t cycles_per_period_;
  float load_per_cycle_;
};

}  // namespace inkwell::link
