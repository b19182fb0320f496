// What the main loop does each time that it comes round, beside the USB.
#pragma once

#include "background_watch.hpp"

namespace inkwell::application {

/// The control interrupt misses a main loop that did not come round for longer.
inline constexpr std::uint32_t main_loop_stalled_periods = control::periods_in(protocol::main_loop_stalled_s);

/// Once a round. The watchdog is fed only if the control interrupt ran too, so it bites when either hangs; the control
/// interrupt misses the rounds sooner.
void prove_that_it_runs();

/// Goes on with the self-test, if there is one.
void follow_self_test(const BackgroundWatch& background_watch);

/// Before the control interrupt runs: the motors are as warm as the run before left them, unless the power has just
/// come.
void take_motor_heat(bool power_has_come);

/// Keeps how warm they are for the next start.
void keep_motor_heat();

/// By the status LED.
void show_state();

}  // namespace inkwell::application
