// The independent watchdog (RM0090, chapter IWDG): resets the chip unless it is fed.
#pragma once

#include <drivers/claims.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

class IndependentWatchdog {
 public:
  static constexpr std::array claims{peripheral<registers::IWDG>()};

  /// Once started it cannot be stopped. It bites after 20 ms, 14 to 38 ms over the spread of its oscillator. A
  /// debugger that halts the processor halts it too. False if it has not taken that time, because its oscillator does
  /// not run.
  bool start();

  void feed();
};

}  // namespace inkwell::drivers
