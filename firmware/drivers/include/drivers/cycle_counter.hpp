// The processor's cycle counter (ARMv7-M, DWT): measures the stages of the control interrupt.
#pragma once

#include <cstdint>

#include <registers/processor.hpp>

namespace inkwell::drivers {

class CycleCounter {
 public:
  static void start() {
    using registers::CORE_DEBUG;
    using registers::DWT;
    CORE_DEBUG::DEMCR::modify(CORE_DEBUG::DEMCR::TRCENA(1));
    DWT::CYCCNT::write(0);
    DWT::CTRL::modify(DWT::CTRL::CYCCNTENA(1));
  }

  static std::uint32_t now() { return registers::DWT::CYCCNT::read(); }

  /// Begins the first lap of a control period.
  void begin() { last_ = now(); }

  /// Cycles since the last lap, right over a wrap of the counter.
  std::uint32_t lap() {
    const std::uint32_t present = now();
    const std::uint32_t cycles = present - last_;
    last_ = present;
    return cycles;
  }

 private:
  std::uint32_t last_ = 0;
};

}  // namespace inkwell::drivers
