// Validates scope frames and decodes them to samples.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "protocol/scope.hpp"
#include "protocol/signals.hpp"

namespace inkwell::device {

/// Samples of consecutive control periods. Signal j of sample i is values[i * signals.size() + j].
struct ScopeSamples {
  std::vector<protocol::Signal> signals;
  std::int64_t first_period = 0;
  std::size_t count = 0;
  std::vector<float> values;
  std::uint64_t lost_before = 0;  ///< number of control periods without samples since the previous samples
};

/// Throws Error if the scope cannot transmit these signals: a signal twice among more than scope_signals_maximum
/// signals.
void check_selection(std::span<const protocol::Signal> signals);
/// Returns the selection for a command: a list, or a bit mask for more than scope_signals_maximum signals.
protocol::SignalSelection selection_of(std::span<const protocol::Signal> signals);

class ScopeDecoder {
 public:
  /// Sets the signals that the command with this token selects, at most scope_wide_maximum. More than
  /// scope_signals_maximum signals must differ. The samples contain the signals in this order. The signals after the
  /// 32nd in the order of the table keep their value for up to scope_slow_interval samples.
  void expect(std::uint8_t token, std::vector<protocol::Signal> signals);

  /// Rejects all samples from control periods before `period`, because they belong to an earlier program.
  void forget_before(std::uint32_t period) { first_wanted_period_ = period; }
  /// Call this before each selection, at most 29 hours after forget_before(). Otherwise the 32-bit period counter may
  /// wrap, and new frames may be rejected.
  void pass_time(std::uint32_t now_period) {
    constexpr std::uint32_t recent_periods = 0x4000'0000;
    if (first_wanted_period_ && now_period - *first_wanted_period_ > recent_periods) first_wanted_period_ = now_period;
  }

  /// Decodes one frame. Returns std::nullopt for a malformed frame and for a frame of an older selection. Only
  /// malformed frames are counted. `first_period` has 32 bits.
  /// `lost_before` counts the control periods between the previous frame and this frame. A missing frame at the start
  /// of a selection counts as one period, because its sample count is unknown.
  /// After a stop of the scope, the first transfer may be the end of a frame without a header. This transfer is not
  /// counted as malformed.
  std::optional<ScopeSamples> decode(std::span<const std::byte> scope_frame);

  std::uint64_t malformed_frames() const { return malformed_frames_; }

 private:
  std::optional<ScopeSamples> refuse();
  std::optional<ScopeSamples> refuse_all_but_a_rest();
  std::uint64_t lost_before(const protocol::ScopeFrameHeader& header) const;

  std::vector<protocol::Signal> signals_;
  std::vector<std::size_t> columns_;  ///< index in signals_ of each transmitted signal
  protocol::SignalSelection selection_{};
  std::optional<std::uint8_t> token_;
  std::optional<std::uint32_t> next_period_;
  std::optional<std::uint32_t> first_wanted_period_;
  bool may_begin_with_rest_ = false;  ///< The first transfer may be the end of an old frame.
  std::uint64_t malformed_frames_ = 0;
};

}  // namespace inkwell::device
