// Decodes scope frames to samples. Decoding has no side effects, and all received bytes are validated.
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

/// Samples of consecutive control periods, decoded: values[i * signals.size() + j] is signal j of sample i.
struct ScopeSamples {
  std::vector<protocol::Signal> signals;
  std::int64_t first_period = 0;
  std::size_t count = 0;
  std::vector<float> values;
  std::uint64_t lost_before = 0;  ///< control periods lost between the previous samples and these
};

class ScopeDecoder {
 public:
  /// Announces the signals that the select_signals command with this token selects, at most scope_signals_maximum.
  void expect(std::uint8_t token, std::vector<protocol::Signal> signals);

  /// Rejects all samples from control periods before `period`, because these samples belong to an earlier program. An
  /// endpoint may retain its last frame for hours.
  void forget_before(std::uint32_t period) { first_wanted_period_ = period; }
  /// Call this with the current control period before each selection. Otherwise, a frame more than 29 hours after the
  /// period of forget_before() would seem to precede that period, because the 32-bit counter wraps.
  void pass_time(std::uint32_t now_period) {
    constexpr std::uint32_t recent_periods = 0x4000'0000;
    if (first_wanted_period_ && now_period - *first_wanted_period_ > recent_periods) first_wanted_period_ = now_period;
  }

  /// The samples of one frame. None if the frame is malformed (counted) or does not belong to the newest selection.
  /// `first_period` is not widened.
  ///
  /// `lost_before` counts the control periods between the previously decoded frame and this frame. If the first frames
  /// of a selection are missing, their sample counts are unknown. Each missing frame then counts as one period.
  ///
  /// A program that releases the scope cancels its transfers, possibly in the middle of a frame. The device sends the
  /// rest of the frame to the next reader. Therefore, the first transfer after a stop of the scope may lack a header
  /// and is not counted as malformed.
  std::optional<ScopeSamples> decode(std::span<const std::byte> scope_frame);

  std::uint64_t malformed_frames() const { return malformed_frames_; }

 private:
  std::optional<ScopeSamples> refuse();
  std::optional<ScopeSamples> refuse_all_but_a_rest();
  std::uint64_t lost_before(const protocol::ScopeFrameHeader& header) const;

  std::vector<protocol::Signal> signals_;
  protocol::SignalSelection selection_{};
  std::optional<std::uint8_t> token_;
  std::optional<std::uint32_t> next_period_;
  std::optional<std::uint32_t> first_wanted_period_;
  bool may_begin_with_rest_ = false;  ///< rest of a frame whose beginning went to the previous reader
  std::uint64_t malformed_frames_ = 0;
};

}  // namespace inkwell::device
