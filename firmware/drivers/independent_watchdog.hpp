// The independent watchdog (RM0090, chapter IWDG) resets the chip if the firmware stops feeding the watchdog.
#pragma once

#include <cstdint>

#include "firmware/drivers/claims.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

class IndependentWatchdog {
 public:
  static constexpr std::array claims{peripheral<registers::IWDG>()};

  static constexpr std::uint32_t oscillator_Hz = 32'000, fastest_oscillator_Hz = 47'000;  // 17 to 47 kHz (data sheet)
  static constexpr std::uint32_t timeout_ms = 20;
  static constexpr float shortest_timeout_s =
      1e-3f * timeout_ms * static_cast<float>(oscillator_Hz) / static_cast<float>(fastest_oscillator_Hz);

  /// Starts the watchdog. A running watchdog cannot be stopped. The nominal timeout is 20 ms. With the tolerance of the
  /// watchdog oscillator, the timeout is 14 to 38 ms. The watchdog pauses while a debugger halts the processor. Returns
  /// false if the watchdog did not accept the timeout, because the watchdog oscillator does not run.
  bool start();

  void feed();
};

}  // namespace inkwell::drivers
