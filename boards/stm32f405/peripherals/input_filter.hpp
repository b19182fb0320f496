// Digital filter of a timer input (RM0090, TIMx_CCMR1: ICxF).
//
// The model computes the time at which a stable level passes the filter.
#pragma once

#include <cstdint>

#include "boards/stm32f405/core/clock.hpp"

namespace inkwell::virtual_board {

/// The output changes after `samples` equal samples. The filter samples once per `divider` timer cycles.
struct InputFilterSetting {
  std::uint32_t divider = 1;
  std::uint32_t samples = 1;
  bool operator==(const InputFilterSetting&) const = default;

  /// Filter setting for the ICxF code and CR1.CKD. With code 0 each sample passes.
  static constexpr InputFilterSetting of(unsigned code, unsigned clock_division) {
    constexpr InputFilterSetting by_code[] = {{1, 1}, {1, 2}, {1, 4},  {1, 8},  {2, 6},  {2, 8},  {4, 6},  {4, 8},
                                              {8, 6}, {8, 8}, {16, 5}, {16, 6}, {16, 8}, {32, 5}, {32, 6}, {32, 8}};
    InputFilterSetting setting = by_code[code & 15];
    // Codes 1 to 3 sample with the timer clock, codes above 3 with tDTS.
    if (code == 0 || code > 3) setting.divider <<= clock_division;
    return setting;
  }
};

class InputFilter {
 public:
  /// Filtered level.
  bool output() const { return output_; }
  /// Time of the next change of output() if the input does not change.
  Ticks next_change() const { return passes_at_; }
  /// Call this function when board time reaches next_change().
  void pass() {
    output_ = input_;
    passes_at_ = never;
  }

  /// Sets the input level from `when` on. Before the call, pass() must have handled all earlier changes.
  void drive(bool high, Ticks when) {
    if (high == input_) return;
    input_ = high;
    if (input_ == output_) {
      left_at_sample_ = sample_at(when);
      passes_at_ = never;
      return;
    }
    // If the opposite level was too short to be sampled, the sequence of samples continues.
    if (sample_at(when) != left_at_sample_) first_sample_ = sample_at(when);
    left_at_sample_ = never;
    passes_at_ = (first_sample_ + samples_ - 1) * period_;
  }

  /// Sets the initial level without an edge.
  void connect(bool high) {
    input_ = output_ = high;
    passes_at_ = left_at_sample_ = never;
  }

  /// Restarts the sequence of samples at `now`.
  void configure(const InputFilterSetting& setting, const Clock& clock, Ticks now) {
    const Ticks period = clock.runs() ? clock.duration(setting.divider) : 1;
    if (period == period_ && setting.samples == samples_) return;
    period_ = period;
    samples_ = setting.samples;
    left_at_sample_ = never;
    if (passes_at_ == never) return;
    first_sample_ = sample_at(now);
    passes_at_ = (first_sample_ + samples_ - 1) * period_;
  }

 private:
  /// Index of the first sample at or after `when`.
  std::uint64_t sample_at(Ticks when) const { return (when + period_ - 1) / period_; }

  Ticks period_ = 1;
  std::uint32_t samples_ = 1;
  bool input_ = false, output_ = false;
  Ticks passes_at_ = never;
  std::uint64_t first_sample_ = 0;
  std::uint64_t left_at_sample_ = never;
};

}  // namespace inkwell::virtual_board
