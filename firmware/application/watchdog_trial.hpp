// Whether the watchdog bites, tried each time that the power comes: everything else of it can be looked at, its bite
// has to be felt.
#pragma once

#include <drivers/system.hpp>

namespace inkwell::application {

struct WatchdogTrial {
  drivers::ResetCause cause;  ///< of the start; the trial's own bite is none
  bool is_passed;             ///< it bit in its time, or was not tried since the power came
  float bitten_after_ms;      ///< 0 if it has not
};

/// When the power has come the watchdog bites in here, 14 to 38 ms later, and the next start tells what that showed.
/// After other resets it tells what was found when the power came. Call it first: no bridge, clock or interrupt is to
/// run meanwhile, and the cycle counter counts at the internal oscillator's rate.
WatchdogTrial try_watchdog(const drivers::ResetCause& cause);

}  // namespace inkwell::application
