// Checks the levels of the wires to the bridges. The input register shows the level at the pad even while the chip
// drives the pin. A short circuit to ground or a supply overrides the chip's output.
//
// While the bridges are off, the enable wire, the monostable output and all legs must be low. While the bridges are on,
// the enable wire must be high. While the bridges are on, the control interrupt checks the monostable output. The legs
// switch while the bridges are on, so the leg levels are not checked. MotorCheck detects a leg that does not switch.
// The heartbeat is high only during the control interrupt, so the main loop always reads a low level.
#pragma once

#include <cstdint>

namespace inkwell::control {

/// Levels at one instant.
struct BridgePins {
  bool on = false;  ///< state commanded by the control interrupt
  bool enable_is_high = false;
  bool heartbeat_is_high = false;
  bool hold_is_high = false;
  bool a_leg_is_high = false;
};

struct BridgeWire {
  /// Number of tolerated consecutive wrong readings. A single wrong reading may be a spike.
  static constexpr std::uint32_t tolerated_readings = 1;

  std::uint32_t wrong_readings = 0;

  /// Checks one reading of the levels.
  constexpr void update(const BridgePins& pins) {
    const bool wrong =
        pins.heartbeat_is_high ||
        (pins.on ? !pins.enable_is_high : pins.enable_is_high || pins.hold_is_high || pins.a_leg_is_high);
    if (!wrong)
      wrong_readings = 0;
    else if (!is_shorted())
      ++wrong_readings;
  }

  /// Returns true if the wire level was wrong in more than `tolerated_readings` consecutive readings.
  constexpr bool is_shorted() const { return wrong_readings > tolerated_readings; }
};

}  // namespace inkwell::control
