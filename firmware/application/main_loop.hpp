// The main loop calls these functions in each round.
#pragma once

#include "firmware/application/background_check.hpp"

namespace inkwell::application {

/// If the main loop completes no round within this time, the control interrupt raises a fault.
inline constexpr std::uint32_t main_loop_stalled_periods = control::periods_in(protocol::main_loop_stalled_s);

/// Call this function once per round of the main loop. This function feeds the watchdog if the control interrupt has
/// run since the previous call. The watchdog expires if the main loop or the control interrupt hangs. The control
/// interrupt detects a main loop hang before the watchdog expires.
void feed_watchdogs();

/// Continues a self-test that is in progress.
void follow_self_test(const BackgroundCheck& background_check);

/// Restores the motor heat of the previous run, except after power-on. Call this function before the control interrupt
/// is enabled.
void take_motor_heat(bool after_power_on);

/// Stores the motor heat for the next boot.
void keep_motor_heat();

/// Shows the state with the status LED.
void show_state();

}  // namespace inkwell::application
