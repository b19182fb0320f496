// The newest pose, from the control interrupt to the main loop.
#pragma once

#include <cstdint>
#include <optional>

#include <link/sample_ring.hpp>
#include <link/shared.hpp>
#include <protocol/reports.hpp>

namespace inkwell::link {

/// Board time of a moment.
struct BoardTime {
  std::uint32_t periods;  ///< the control period it lies in
  std::uint32_t cycles;   ///< processor cycles since the begin of that period
};

/// The main loop makes a report of the newest sample when the bus wants one.
class PoseRecorder {
 public:
  PoseRecorder(const SampleRing& samples, std::uint32_t cycles_per_period)
      : samples_(samples),
        cycles_per_period_(cycles_per_period),
        load_per_cycle_(255.0f / static_cast<float>(cycles_per_period)) {}

  // ---- control interrupt ----

  /// Called every period, with the longest interrupt known so far: this one or the one before it.
  void note_load(std::uint32_t servo_cycles) {
    if (longest_was_taken_.load()) {
      longest_was_taken_.store(false);
      longest_cycles_.store(servo_cycles);
    } else if (servo_cycles > longest_cycles_.load()) {
      longest_cycles_.store(servo_cycles);
    }
  }

  // ---- main loop ----

  /// The newest pose, without a sequence and driver parity; false before the first period.
  bool read(protocol::PoseReport& report) const;

  /// The same for a report that is sent: the longest interrupt is looked for anew.
  bool take(protocol::PoseReport& report);

  /// That of read() was sent after all.
  void note_taken() { longest_was_taken_.store(true); }

  /// Of the control interrupt, since the last report that was taken.
  std::uint32_t longest_cycles() const { return longest_cycles_.load(); }

  /// Number of the newest control period; 0 before the first.
  std::uint32_t newest_periods() const;

  /// The cycle counter when the newest pose's control interrupt began; nothing before the first period.
  std::optional<std::uint32_t> newest_cycles() const;

  /// Board time at a moment of the cycle counter that is less than 12 s ago; nothing if there is no pose to count from.
  std::optional<BoardTime> time_of(std::uint32_t cycles) const;

 private:
  const SampleRing& samples_;
  Shared<bool> longest_was_taken_{false};    ///< set by the main loop, cleared by the interrupt
  Shared<std::uint32_t> longest_cycles_{0};  ///< written by the interrupt
  std::uint32_t cycles_per_period_;
  float load_per_cycle_;
};

}  // namespace inkwell::link
