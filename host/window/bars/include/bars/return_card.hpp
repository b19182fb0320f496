// A card over the scene after a reconnection. The card compares the device's values with the values before the loss.
#pragma once

#include <cstdint>

#include <device_desk/returned_values.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

enum class ReturnChoice : std::uint8_t {
  none,
  send,  ///< restore the previous values
  keep,  ///< keep the device's current values
};

/// Draws the card in the upper right corner of a scene with this position and size.
ReturnChoice draw_return_card(ImVec2 place, ImVec2 size, const Style& style, const ReturnedValues& values,
                              bool force_is_on);

}  // namespace inkwell::window
