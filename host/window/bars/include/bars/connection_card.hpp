// How the window says whether it is connected.
#pragma once

#include <device_desk/device_desk.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

const char* connection_title(const device::SessionStatus& status);
Colour connection_colour(device::Connection connection, const Palette& palette);

/// A card in the middle of the scene that says why no device is connected and what to do.
void draw_connection_card(ImVec2 centre, const Style& style, const DeviceView& view);

}  // namespace inkwell::window
