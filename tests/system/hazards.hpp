// What tests of hazards share: a sphere pressed into a wall, and what the bridges then get.
#pragma once

#include <string>

#include <protocol/faults.hpp>

#include "board_rig.hpp"

namespace inkwell::tests {

inline constexpr double control_period_s = 1.0 / protocol::servo_rate_Hz;

/// After a restart of the board: waits until its USB is back and opens the device again.
void reconnect(BoardRig& rig);

bool any_leg_high(device::ControlClient& control);
/// Looks at the inputs of the bridges at 20 instants over a time; says whether any of them was high at any of them.
bool any_leg_high_within(device::ControlClient& control, double time_s);
bool bridges_enabled(device::ControlClient& control);

/// The sphere pressed into a wall by the hand: all three bridges switch, and at least one motor has current.
void press_into_wall(BoardRig& rig);

/// Since the board has come to life, for which its watchdog bites once (firmware/application/watchdog_trial.hpp).
int restarts(device::ControlClient& control);
int watchdog_bites(device::ControlClient& control);

/// What `inkwell info` tells a user about the device of this rig.
std::string told_by_info(BoardRig& rig);
void check_tells(const std::string& text, protocol::Fault fault);

}  // namespace inkwell::tests
