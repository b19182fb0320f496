// A card over the scene after a reconnection: what the device holds now, compared with what it held before.
#pragma once

#include <cstdint>

#include <device_desk/returned_values.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

enum class ReturnChoice : std::uint8_t {
  none,
  send,  ///< the values of before
  keep,  ///< those that the device holds
};

/// In the right upper corner of a scene of this place and size.
ReturnChoice draw_return_card(ImVec2 place, ImVec2 size, const Style& style, const ReturnedValues& values,
                              bool force_is_on);

}  // namespace inkwell::window
