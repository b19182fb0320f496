// Status LED. The patterns of the LED can be distinguished without counting.
#pragma once

#include <cstdint>

#include "firmware/drivers/pins.hpp"

namespace inkwell::drivers {

enum class LedPattern : std::uint8_t {
  slow_blink,  ///< once per second: waits for the stylus in the inkwell
  steady,      ///< pose is valid
  fast_blink,  ///< five times per second: fault
};

class StatusLed {
 public:
  static constexpr std::array claims{pin(board::facts.status_led)};

  void start() {
    Output::start();
    set(false);
  }
  void set(bool on) { Output::set(on != board::facts.status_led_shines_when_low); }

  /// Call this function often. `time_periods` is the time in control periods.
  void show(LedPattern pattern, std::uint32_t time_periods) {
    set(pattern == LedPattern::steady || time_periods % period(pattern) < period(pattern) / 2);
  }

 private:
  using Output = DigitalOutput<StatusLed, board::facts.status_led>;

  static constexpr std::uint32_t period(LedPattern pattern) {
    return pattern == LedPattern::fast_blink ? board::servo_rate_Hz / 5 : board::servo_rate_Hz;
  }
};

}  // namespace inkwell::drivers
