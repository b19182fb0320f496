// What of the device's values outlives its power, judged for the user.
#pragma once

#include <string>
#include <vector>

#include <device_desk/device_desk.hpp>

namespace inkwell::window {

/// The values that would be lost with the power; none while it is not known.
std::vector<protocol::Parameter> not_stored(const DeviceView& view);

/// "3 values are not stored", "All values are stored", "Nothing is stored, all values are defaults".
std::string stored_title(const DeviceView& view);

/// Why the board would not store or forget anything now, with what to do; empty if it would.
std::string why_storing_waits(const DeviceView& view);

}  // namespace inkwell::window
