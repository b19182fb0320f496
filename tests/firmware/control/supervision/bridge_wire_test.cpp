// Tests the detection of shorted bridge wires from their pin levels.
#include <doctest/doctest.h>

#include "firmware/control/supervision/bridge_wire.hpp"

namespace {

using inkwell::control::BridgePins;
using inkwell::control::BridgeWire;

/// Returns the number of checks until detection, or 0 if the short circuit is never detected.
int readings_until_shorted(const BridgePins& pins) {
  BridgeWire wire;
  for (int reading = 1; reading < 1'000; ++reading) {
    wire.update(pins);
    if (wire.is_shorted()) return reading;
  }
  return 0;
}

TEST_CASE("while the bridges are off every wire must be low, while they are on the enable wire must be high") {
  struct Row {
    BridgePins pins;
    bool healthy;
  };
  constexpr Row rows[] = {
      {{.on = false, .enable_is_high = false, .heartbeat_is_high = false, .a_leg_is_high = false}, true},
      {{.on = false, .enable_is_high = true, .heartbeat_is_high = false, .a_leg_is_high = false}, false},
      {{.on = false, .enable_is_high = false, .heartbeat_is_high = false, .a_leg_is_high = true}, false},
      {{.on = false, .enable_is_high = true, .heartbeat_is_high = false, .a_leg_is_high = true}, false},
      {{.on = true, .enable_is_high = true, .heartbeat_is_high = false, .a_leg_is_high = false}, true},
      {{.on = true, .enable_is_high = true, .heartbeat_is_high = false, .a_leg_is_high = true}, true},
      {{.on = true, .enable_is_high = false, .heartbeat_is_high = false, .a_leg_is_high = false}, false},
      {{.on = true, .enable_is_high = false, .heartbeat_is_high = false, .a_leg_is_high = true}, false}};
  for (const Row& row : rows) {
    CAPTURE(row.pins.on);
    CAPTURE(row.pins.enable_is_high);
    CAPTURE(row.pins.a_leg_is_high);
    CHECK(readings_until_shorted(row.pins) == (row.healthy ? 0 : 2));
  }
}

TEST_CASE(
    "a heartbeat that is high outside the control interrupt touches something, whether the bridges are on or off") {
  CHECK(readings_until_shorted(
            {.on = false, .enable_is_high = false, .heartbeat_is_high = true, .a_leg_is_high = false}) == 2);
  CHECK(readings_until_shorted(
            {.on = true, .enable_is_high = true, .heartbeat_is_high = true, .a_leg_is_high = false}) == 2);
}

TEST_CASE("a high hold pin is a short only while the bridges should be off") {
  CHECK(readings_until_shorted({.on = false, .hold_is_high = true}) == 2);
  CHECK(readings_until_shorted({.on = true, .enable_is_high = true, .hold_is_high = true}) == 0);
  CHECK(readings_until_shorted({.on = true, .enable_is_high = true, .hold_is_high = false}) == 0);
}

TEST_CASE("a single wrong reading raises no fault, and a correct reading resets the count") {
  constexpr BridgePins healthy{}, wrong{.enable_is_high = true};
  BridgeWire wire;
  for (int i = 0; i < 100; ++i) {
    wire.update(wrong);
    CHECK_FALSE(wire.is_shorted());
    wire.update(healthy);
  }
  for (int i = 0; i < 2; ++i) wire.update(wrong);
  CHECK(wire.is_shorted());
  wire.update(healthy);
  CHECK_FALSE(wire.is_shorted());
}

}  // namespace
