// Cycle counter of the processor (ARMv7-M, DWT). The counter measures the stages of the control interrupt and limits
// waits in the drivers.
#pragma once

#include <cstdint>

#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

class CycleCounter {
 public:
  static void start() {
    using registers::CORE_DEBUG;
    using registers::DWT;
    CORE_DEBUG::DEMCR::modify(CORE_DEBUG::DEMCR::TRCENA(1));
    DWT::CTRL::modify(DWT::CTRL::CYCCNTENA(1));
  }

  static std::uint32_t now() { return registers::DWT::CYCCNT::read(); }

  /// Begins the first lap of a control period and returns the present count.
  std::uint32_t begin() { return last_ = now(); }

  /// Returns the cycles since the last lap. The result is correct even if the counter wraps.
  std::uint32_t lap() {
    const std::uint32_t present = now();
    const std::uint32_t cycles = present - last_;
    last_ = present;
    return cycles;
  }

 private:
  std::uint32_t last_ = 0;
};

/// Waits at most `limit_cycles` until a condition is true. Returns true if the condition became true.
template <class Condition>
[[nodiscard]] bool wait_for(std::uint32_t limit_cycles, Condition condition) {
  const std::uint32_t from = CycleCounter::now();
  while (!condition())
    if (CycleCounter::now() - from > limit_cycles) return condition();  // an interrupt may have used up the time
  return true;
}

inline void wait(std::uint32_t cycles) {
  static_cast<void>(wait_for(cycles, [] { return false; }));
}

}  // namespace inkwell::drivers
