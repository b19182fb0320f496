// The card compares the parameter values before and after a reconnection.
#pragma once

#include <cstdint>

#include "host/companion/window/device_desk/returned_values.hpp"
#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

enum class ReturnChoice : std::uint8_t {
  none,
  send,  ///< restore the previous values
  keep,  ///< keep the device's current values
};

/// Draws the card in the upper right corner of the scene. `origin`, `size`: rectangle of the scene.
ReturnChoice draw_return_card(ImVec2 origin, ImVec2 size, const Style& style, const ReturnedValues& values,
                              bool force_is_on);

}  // namespace inkwell::window
