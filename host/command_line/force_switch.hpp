// The force, switched by a command.
#pragma once

#include <string>

#include <device/device.hpp>
#include <protocol/reports.hpp>

namespace inkwell::command_line {

/// Switches the force on and waits until it is. Throws device::Error with the reason if the device does not.
void switch_force_on(device::Device& device);

/// Switches the force off, whoever switched it on, and returns the pose that tells so.
protocol::PoseReport switch_force_off(device::Device& device);

/// Whether the force is on, and what keeps it off: a sentence with the remedy.
std::string force_sentence(const protocol::PoseReport& pose);

/// Why the force, which was on, no longer is.
std::string why_force_went_off(const protocol::PoseReport& pose);

}  // namespace inkwell::command_line
