// Conversion of timer counts to joint angles.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

/// Extends the count of a wrapping 16-bit or 32-bit timer. Among all counts with the lower bits `timer_count`, returns
/// the count nearest to `unwrapped`. The result is valid if the timer changes by less than half its range between two
/// calls.
template <class TimerCount>
constexpr std::int32_t unwrap(std::int32_t unwrapped, TimerCount timer_count) {
  static_assert(std::is_unsigned_v<TimerCount> && sizeof(TimerCount) <= 4);
  using Signed = std::make_signed_t<TimerCount>;
  const auto step = static_cast<Signed>(static_cast<TimerCount>(timer_count - static_cast<TimerCount>(unwrapped)));
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(unwrapped) + static_cast<std::uint32_t>(step));
}

/// Returns a nonzero value if an encoder moved by at least EncoderScale::jump_counts. For backward motion the bound is
/// one count higher.
constexpr std::uint32_t jumps(const std::array<std::int32_t, 3>& before, const std::array<std::int32_t, 3>& now,
                              std::uint32_t jump_counts) {
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < 3; ++i)
    all |= static_cast<std::uint32_t>(now[i]) - static_cast<std::uint32_t>(before[i]) + jump_counts;
  return all & (0u - 2 * jump_counts);
}

struct EncoderScale {
  Triple rad_per_count;  ///< negative if the encoder counts down as its joint turns forward
  Triple inkwell_rad;    ///< joint angles while the stylus is in the inkwell
  /// Smallest count change of an encoder jump in one control period. No joint is faster than 100 rad/s. The value is a
  /// power of two, so that one test covers all three encoders.
  std::uint32_t jump_counts;
};

/// Returns the joint angles (paper, section 3.1).
constexpr Triple joint_angles(const std::array<std::int32_t, 3>& counts_since_inkwell, const EncoderScale& scale) {
  Triple joint_rad{};
  for (std::size_t i = 0; i < 3; ++i)
    joint_rad[i] = scale.inkwell_rad[i] + static_cast<float>(counts_since_inkwell[i]) * scale.rad_per_count[i];
  return joint_rad;
}

}  // namespace inkwell::control
