// Watchdog trial at each power-on. Only a reset proves that the watchdog expires. All other properties of the watchdog
// can be read from registers.
#pragma once

#include "firmware/drivers/system.hpp"

namespace inkwell::application {

struct WatchdogTrial {
  drivers::ResetCause cause;  ///< cause of this boot; the reset of the trial does not count
  bool is_passed;             ///< expired in time, or was not tried since power-on
  float expired_after_ms;     ///< 0 if the watchdog did not expire
};

/// At power-on, this function waits until the watchdog resets the chip. The call after this reset returns the result.
/// After other resets the function returns the result of the last power-on. Call this function first, because no
/// bridge, clock or interrupt may be active during the trial. The cycle counter must count at the frequency of the
/// internal oscillator.
WatchdogTrial try_watchdog(const drivers::ResetCause& cause);

}  // namespace inkwell::application
