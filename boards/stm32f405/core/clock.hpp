// Clocks of the chip. Clock cycles are converted exactly to ticks of board time.
#pragma once

#include <cstdint>
#include <limits>
#include <numeric>
#include "boards/stm32f405/core/interfaces.hpp"

namespace inkwell::virtual_board {

inline constexpr Ticks never = std::numeric_limits<Ticks>::max();

/// The period of a clock is numerator / denominator ticks. The denominator is 1 if ticks_per_s is a multiple of the
/// frequency.
struct Clock {
  /// Products of cycles and periods can exceed 64 bits.
  __extension__ using Wide = unsigned __int128;

  std::uint64_t numerator = 0;  ///< 0: the clock is stopped
  std::uint64_t denominator = 1;

  static Clock of(std::uint32_t frequency_Hz) {
    if (frequency_Hz == 0) return {};
    const std::uint64_t common = std::gcd(ticks_per_s, static_cast<std::uint64_t>(frequency_Hz));
    return {ticks_per_s / common, frequency_Hz / common};
  }
  bool runs() const { return numerator != 0; }
  bool operator==(const Clock&) const = default;

  /// Duration of `cycles` clock cycles.
  Ticks duration(std::uint64_t cycles) const {
    if (denominator == 1) return cycles * numerator;
    return static_cast<Ticks>((Wide{cycles} * numerator + denominator - 1) / denominator);
  }
  /// Number of whole cycles within `time`.
  std::uint64_t cycles_in(Ticks time) const {
    if (!runs()) return 0;
    if (denominator == 1) return time / numerator;
    return static_cast<std::uint64_t>(Wide{time} * denominator / numerator);
  }
  /// Number of whole `divider`-cycle periods within `time`.
  std::uint64_t periods_in(Ticks time, std::uint64_t divider) const { return cycles_in(time) / divider; }
};

/// Configured frequencies in Hz. A stopped clock has 0.
struct Clocks {
  std::uint32_t system_Hz, hclk_Hz, pclk1_Hz, pclk2_Hz;
  std::uint32_t timer1_Hz;  ///< timers on APB1
  std::uint32_t timer2_Hz;  ///< timers on APB2
  std::uint32_t usb_Hz;     ///< PLL48CLK
};

/// Configured clocks (RM0090, figure "Clock tree").
struct ClockTree {
  Clock hclk, pclk1, pclk2, timer1, timer2, usb, low_speed_internal;
  Clocks frequencies{};
  bool operator==(const ClockTree& other) const {
    return hclk == other.hclk && pclk1 == other.pclk1 && pclk2 == other.pclk2 && timer1 == other.timer1 &&
           timer2 == other.timer2 && usb == other.usb;
  }
};

/// Interface that notifies a model of clock changes.
class ClockUser {
 public:
  virtual ~ClockUser() = default;
  virtual void before_clock_change() = 0;  ///< update up to now with the old clock
  virtual void after_clock_change() = 0;   ///< continue from now with the new clock
};

}  // namespace inkwell::virtual_board
