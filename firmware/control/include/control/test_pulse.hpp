// Pulses for testing and identifying a motor: commands test_current and test_voltage.
#pragma once

#include <cstdint>

namespace inkwell::control {

/// A pulse under way: `amplitude` for half of the time, then zero for as long, so that the decay is seen too.
struct TestPulse {
  enum class Quantity : std::uint8_t { current, voltage };

  Quantity quantity = Quantity::current;
  std::uint8_t motor = 0;              ///< index 0..2
  float amplitude = 0.0f;              ///< A or V
  std::uint32_t pulse_periods = 0;     ///< length of the pulse, and of the rest after it
  std::uint32_t remaining_periods = 0; ///< of both together; 0 when no test runs

  bool runs() const { return remaining_periods > 0; }
  /// What is asked of the motor in this period.
  float value() const { return remaining_periods > pulse_periods ? amplitude : 0.0f; }
};

}  // namespace inkwell::control
