// Whether the wires to the bridges are at the levels that the chip gives them. A pin can be read while the chip drives
// it, and shows what is at its pad: a wire that touches ground or a supply wins against the chip's output.
//
// While the bridges are off the enable wire, the monostable's output and all legs must be low, and while they are on
// the enable wire must be high; that the output is so too is looked at in each control period. The legs then switch and
// tell nothing; that a motor does as they say is what control/motor_watch.hpp looks at. The heartbeat is high in the
// control interrupt only, and whoever can look at it is not in that.
#pragma once

#include <cstdint>

namespace inkwell::control {

/// All of one instant.
struct BridgePins {
  bool on = false;  ///< what the control interrupt told the bridges
  bool enable_is_high = false;
  bool heartbeat_is_high = false;
  bool hold_is_high = false;
  bool a_leg_is_high = false;
};

struct BridgeWire {
  /// In a row. A wire settles within a microsecond; one look may meet a spike.
  static constexpr std::uint32_t bearable_looks = 1;

  std::uint32_t wrong_looks = 0;
};

/// Whether a wire has not been at its level for more than what is bearable.
constexpr bool touches(const BridgeWire& wire) { return wire.wrong_looks > BridgeWire::bearable_looks; }

/// One look.
constexpr void look_at(BridgeWire& wire, const BridgePins& pins) {
  const bool wrong = pins.heartbeat_is_high ||
                     (pins.on ? !pins.enable_is_high : pins.enable_is_high || pins.hold_is_high || pins.a_leg_is_high);
  if (!wrong)
    wire.wrong_looks = 0;
  else if (!touches(wire))
    ++wire.wrong_looks;
}

}  // namespace inkwell::control
