// Reset causes and processor counters.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "boards/stm32f405/core/exception_numbers.hpp"
#include "boards/stm32f405/core/interfaces.hpp"

namespace inkwell::virtual_board {

/// Reset flags. The order is RCC_CSR bit 26 to bit 31, then bit 25.
enum class ResetCause : std::uint8_t {
  pin,
  power_on,
  software,
  independent_watchdog,
  window_watchdog,
  low_power,
  brown_out
};
inline constexpr std::size_t reset_causes = 7;

struct ExceptionCounters {
  std::uint64_t count = 0;
  /// Cycles of the longest handler run, with entry and return. Preempting exceptions are not included.
  std::uint64_t longest_cycles = 0;
};

/// Counts since construction or since the last clear_counters().
struct Counters {
  std::uint64_t instructions = 0;
  std::uint64_t cycles = 0;  ///< without sleep
  Ticks duration = 0;
  Ticks asleep = 0;
  std::array<ExceptionCounters, exception_numbers> exceptions{};
  std::array<std::uint32_t, reset_causes> resets{};  ///< by ResetCause
  std::uint32_t all_resets() const { return std::accumulate(resets.begin(), resets.end(), 0u); }
  double sleep_share() const {
    return duration == 0 ? 0.0 : static_cast<double>(asleep) / static_cast<double>(duration);
  }
};

}  // namespace inkwell::virtual_board
