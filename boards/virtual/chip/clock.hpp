// Exact conversion between the cycles of a clock and ticks of board time.
#pragma once

#include <chip/interfaces.hpp>
#include <cstdint>
#include <limits>
#include <numeric>

namespace inkwell::virtual_board {

inline constexpr Ticks never = std::numeric_limits<Ticks>::max();

/// A cycle lasts numerator / denominator ticks. Most clocks of the chip divide ticks_per_s, then the
/// denominator is 1; the others stay exact as fractions.
struct Clock {
  std::uint64_t numerator = 0;  ///< 0: the clock stands still
  std::uint64_t denominator = 1;

  static Clock of(std::uint32_t frequency_Hz) {
    if (frequency_Hz == 0) return {};
    const std::uint64_t common = std::gcd(ticks_per_s, static_cast<std::uint64_t>(frequency_Hz));
    return {ticks_per_s / common, frequency_Hz / common};
  }
  bool runs() const { return numerator != 0; }
  bool operator==(const Clock&) const = default;

  /// The time by which `cycles` are over.
  Ticks duration(std::uint64_t cycles) const {
    const std::uint64_t scaled = cycles * numerator;
    return denominator == 1 ? scaled : (scaled + denominator - 1) / denominator;
  }
  /// Whole cycles within `time`.
  std::uint64_t cycles_in(Ticks time) const { return runs() ? time * denominator / numerator : 0; }
  /// As cycles_in, for a divided clock: whole periods of `divider` cycles.
  std::uint64_t periods_in(Ticks time, std::uint64_t divider) const { return cycles_in(time) / divider; }
};

}  // namespace inkwell::virtual_board
