// Passes the newest pose from the control interrupt to the main loop.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/exchange/shared.hpp"
#include "firmware/record/sample_ring.hpp"
#include "protocol/reports.hpp"

namespace inkwell::link {

/// Board time.
struct BoardTime {
  std::uint32_t periods;  ///< number of the control period
  std::uint32_t cycles;   ///< processor cycles since the start of that period
};

/// Creates pose reports from the newest sample.
class PoseRecorder {
 public:
  PoseRecorder(const SampleRing& samples, std::uint32_t cycles_per_period)
      : samples_(samples),
        cycles_per_period_(cycles_per_period),
        load_per_cycle_(255.0f / static_cast<float>(cycles_per_period)) {}

  // ---- control interrupt ----

  /// Call this function in every control period.
  void note_load(std::uint32_t servo_cycles) {
    if (longest_was_sent_.load()) {
      longest_was_sent_.store(false);
      longest_cycles_.store(servo_cycles);
    } else if (servo_cycles > longest_cycles_.load()) {
      longest_cycles_.store(servo_cycles);
    }
  }

  // ---- main loop ----

  /// Writes the newest pose to `report`, without sequence number and driver parity. Returns false before the first
  /// control period.
  bool read(protocol::PoseReport& report) const;

  /// Calls read() and note_sent().
  bool read_for_report(protocol::PoseReport& report);

  /// Records that the report of read() was sent.
  void note_sent() { longest_was_sent_.store(true); }

  /// Longest control interrupt since the last sent report.
  std::uint32_t longest_cycles() const { return longest_cycles_.load(); }

  /// Number of the newest control period, or 0 before the first period.
  std::uint32_t newest_periods() const;

  /// Returns the cycle counter at the start of the newest control period. Returns std::nullopt before the first control
  /// period.
  std::optional<std::uint32_t> newest_cycles() const;

  /// Converts a cycle counter value to board time. The value must be less than 12 s old. Returns std::nullopt before
  /// the first pose.
  std::optional<BoardTime> time_of(std::uint32_t cycles) const;

 private:
  const SampleRing& samples_;
  Shared<bool> longest_was_sent_{false};     ///< set by the main loop, cleared by the interrupt
  Shared<std::uint32_t> longest_cycles_{0};  ///< written by the interrupt
  std::uint32_t cycles_per_period_;
  float load_per_cycle_;
};

}  // namespace inkwell::link
