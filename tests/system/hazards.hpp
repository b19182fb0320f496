// Shared functions of the hazard tests: a sphere pressed into a wall, and the state of the bridges.
#pragma once

#include <string>

#include "protocol/faults.hpp"

#include "tests/system/board_rig.hpp"

namespace inkwell::tests {

inline constexpr double control_period_s = 1.0 / protocol::servo_rate_Hz;

/// Waits for the USB device after a restart of the board, and opens the device again.
void reconnect(BoardRig& rig);

bool any_leg_high(device::ControlClient& control);
/// Checks the bridge inputs 20 times within `time_s`. Returns true if any input was high.
bool any_leg_high_within(device::ControlClient& control, double time_s);
bool bridges_enabled(device::ControlClient& control);

/// The hand presses the sphere into a wall, so that all three bridges switch and at least one motor has current.
void press_into_wall(BoardRig& rig);

/// Returns the number of restarts since power-on. The restart of the watchdog trial is not counted.
int restarts(device::ControlClient& control);
int watchdog_expires(device::ControlClient& control);

/// Returns the output of `inkwell info` for this device.
std::string reported_by_info(BoardRig& rig);
void check_reports(const std::string& text, protocol::Fault fault);

}  // namespace inkwell::tests
