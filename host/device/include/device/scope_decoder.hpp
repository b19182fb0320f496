// Turns scope frames back into samples. Pure: bytes in, samples out; trusts nothing that came over the wire.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <protocol/scope.hpp>
#include <protocol/signals.hpp>

namespace inkwell::device {

/// Samples of consecutive control periods, decoded: values[i * signals.size() + j] is signal j of sample i.
struct ScopeSamples {
  std::vector<protocol::Signal> signals;
  std::int64_t first_period = 0;
  std::size_t count = 0;
  std::vector<float> values;
  std::uint64_t lost_before = 0;  ///< control periods missing between the samples before and these
};

class ScopeDecoder {
 public:
  /// Tells what the select_signals command with this token asked for. At most scope_signals_maximum signals.
  void expect(std::uint8_t token, std::vector<protocol::Signal> signals);

  /// What was sampled before this control period was for a program that ran earlier, whatever its token: an endpoint
  /// may hold its last frame for hours.
  void forget_before(std::uint32_t period) { first_wanted_period_ = period; }
  /// Call it with the present control period before each selection. A frame that comes 29 hours after the period of
  /// forget_before(), half of the counter's range, would seem to come before it.
  void pass_time(std::uint32_t now_period) {
    constexpr std::uint32_t recent_periods = 0x4000'0000;
    if (first_wanted_period_ && now_period - *first_wanted_period_ > recent_periods) first_wanted_period_ = now_period;
  }

  /// The samples of one frame. None if the frame is malformed (counted) or answers another selection than the
  /// newest (a left-over of the one before, or of a program that ran earlier). `first_period` is not widened.
  ///
  /// `lost_before` counts the control periods between the last frame decoded and this one. If the very first
  /// frames of a selection are missing nobody can know their samples; each then counts as one.
  ///
  /// Who gives the scope up takes its transfers back, maybe amid a frame, the rest of which the device still sends to
  /// the next reader. So one transfer without a header is none that is malformed before the first frame of a selection
  /// that follows on none.
  std::optional<ScopeSamples> decode(std::span<const std::byte> frame);

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
  bool may_begin_with_rest_ = false;  ///< of a frame whose begin went to the reader before
  std::uint64_t malformed_frames_ = 0;
};

}  // namespace inkwell::device
