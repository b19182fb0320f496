// Evaluates the device's stored values for display.
#pragma once

#include <string>
#include <vector>

#include "host/companion/window/device_desk/device_desk.hpp"

namespace inkwell::window {

/// Returns the parameters whose values are not stored; empty while the stored values are unknown.
std::vector<protocol::Parameter> not_stored(const DeviceView& view);

/// Returns a title such as "3 values are not stored".
std::string stored_title(const DeviceView& view);

/// Returns the reason and the remedy if the board refuses to store or erase values.
std::string why_storing_waits(const DeviceView& view);

}  // namespace inkwell::window
