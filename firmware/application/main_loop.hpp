// What the main loop does each time that it comes round, beside the USB.
#pragma once

#include "background_watch.hpp"

namespace inkwell::application {

/// Once a round. The watchdog is fed only if the control interrupt ran too, so it bites when either hangs; the control
/// interrupt misses the rounds sooner.
void prove_that_it_runs();

/// Goes on with the self-test, if there is one.
void follow_self_test(const BackgroundWatch& background_watch);

/// By the status LED.
void show_state();

}  // namespace inkwell::application
