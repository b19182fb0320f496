// What the main loop does each time that it comes round, beside the USB.
#pragma once

#include "background_watch.hpp"

namespace inkwell::application {

/// The watchdog is fed by the main loop, and only if the control interrupt ran: it bites when either hangs.
void feed_watchdog();

/// Goes on with the self-test, if there is one.
void follow_self_test(const BackgroundWatch& background_watch);

/// By the status LED.
void show_state();

}  // namespace inkwell::application
