// The device's stored values, evaluated for display.
#pragma once

#include <string>
#include <vector>

#include <device_desk/device_desk.hpp>

namespace inkwell::window {

/// Returns the parameters whose values would be lost on power loss; empty while this is not known.
std::vector<protocol::Parameter> not_stored(const DeviceView& view);

/// "3 values are not stored", "All values are stored", "Nothing is stored, all values are defaults".
std::string stored_title(const DeviceView& view);

/// Returns why the board would currently refuse to store or erase values, and what to do; empty if it would not refuse.
std::string why_storing_waits(const DeviceView& view);

}  // namespace inkwell::window
