// Functions of the wires between microcontroller and board.
#pragma once

#include <cstdint>
#include <string_view>

namespace inkwell::campaign {

enum class Wire : std::uint8_t {
  encoder,
  bridge_leg,
  bridge_fault_tim1,  ///< fault wire of the bridges at the break input of TIM1
  bridge_fault_tim8,
  bridge_enable,
  bridge_heartbeat,
  bridge_hold,
  motor_current,
  gimbal,
  supply,
  usb_supply,
  button,
  inkwell_switch,
  other,  ///< USB data, console, debug probe, status LED, or no wire
};

/// Returns the function of a wire, for example of `encoders[0].a`. For a pair of wires, returns the function of the
/// first wire.
Wire wire_of(std::string_view name);

}  // namespace inkwell::campaign
