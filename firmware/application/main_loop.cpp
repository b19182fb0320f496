#include "main_loop.hpp"

#include "parts.hpp"

namespace inkwell::application {
namespace {

drivers::LedPattern led_pattern(protocol::State state) {
  switch (state) {
    case protocol::State::starting:
    case protocol::State::unreferenced: return drivers::LedPattern::slow_blink;
    case protocol::State::fault: return drivers::LedPattern::fast_blink;
    default: return drivers::LedPattern::steady;
  }
}

}  // namespace

void feed_watchdog() {
  static std::uint32_t fed_at_periods = 0;
  const std::uint32_t periods = completed_periods.load();
  if (periods != fed_at_periods) watchdog.feed();
  fed_at_periods = periods;
}

void show_state() { status_led.show(led_pattern(host_link.status.state()), completed_periods.load()); }

}  // namespace inkwell::application
