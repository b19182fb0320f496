// The device's stored values, evaluated for display.
#pragma once

#include <string>
#include <vector>

#include "host/companion/window/device_desk/device_desk.hpp"

namespace inkwell::window {

/// Returns the parameters whose values are not stored; empty while the stored values are unknown.
std::vector<protocol::Parameter> not_stored(const DeviceView& view);

/// Returns a title: "3 values are not stored", "All values are stored" or "All values are defaults".
std::string stored_title(const DeviceView& view);

/// Returns the reason why the board refuses to store or erase values, and the remedy; empty: no refusal.
std::string why_storing_waits(const DeviceView& view);

}  // namespace inkwell::window
