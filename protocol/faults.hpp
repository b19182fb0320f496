// Faults and refusals: codes, causes and remedies. Users see these texts.
#pragma once

// To add a fault:
// (1) Append a row with the next code to INKWELL_FAULTS. For a new placeholder in braces, extend with_figures() in
//     host/client/device/fault_text.cpp.
// (2) Add the condition to firmware/control/controller.cpp if the fault must be raised in the same control period. If a
//     delay of about 0.15 ms is acceptable, use firmware/application/background_check.cpp instead. The file
//     firmware/application/control_interrupt.cpp raises the faults for a late interrupt, a stalled main loop and a lost
//     USB connection.
// (3) Add a row to condition_table in protocol/supervision.hpp and a separate row to
//     tests/firmware/control/supervision/supervisor_test.cpp. The row of condition_table sets the monitored states, the
//     clearing, the motor switch-off and the loss of the reference.
// (4) Add an enumerator to host/bindings/library/include/inkwell/inkwell.h and a line to
//     host/bindings/library/c_codes.cpp. The compiler reports a missing line.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace inkwell::protocol {

/// A motor current above this multiple of the current limit raises a fault.
inline constexpr float over_current_ratio = 1.5f;
/// Largest age of the supply and gimbal measurements.
inline constexpr float samples_stale_s = 0.001f;
/// Longest allowed pass of the main loop. The shortest watchdog timeout is longer than main_loop_stalled_s.
inline constexpr float main_loop_stalled_s = 0.01f;
/// Largest deviation of the bridge supply from its mean, in either direction (supply_ripple.hpp).
inline constexpr float supply_ripple_V = 1.0f;
/// Largest relative deviation of the converter reference from its nominal value (analog_supply.hpp).
inline constexpr float analog_supply_tolerance = 0.05f;

// clang-format off
/// X(code, name, cause, remedy). device::fault_text() replaces a name in braces with its value.
#define INKWELL_FAULTS(X)                                                                                                         \
  X(0, none, "No fault.", "Nothing to do.")                                                                                       \
  X(1, bridge_fault, "A bridge reported over-current, over-temperature or under-voltage.", "Check the motor wiring for a short, let the bridges cool, then clear the fault.") \
  X(2, supply_low, "The supply of the bridges is below {supply_minimum_V} V.", "Check the {supply_nominal_V} V supply and its fuse, then clear the fault.")       \
  X(3, supply_high, "The supply of the bridges is above {supply_maximum_V} V.", "Use a supply of {supply_nominal_V} V; if it rises while the arm is moved fast, add bulk capacitance. Then clear the fault.") \
  X(4, current_sensor, "A current sensor does not read zero while its bridge is off.", "Check the shunt amplifier of the motor and the {shunt_amplifier_offset_V} V reference, then clear the fault. If the fault was present from the start, reset the board to measure the offsets again.") \
  X(5, over_current, "A motor current exceeded {over_current_percent} % of its limit, or the range of its sensor.", "Check the motor wiring and lower the gains of the current loop, then clear the fault.") \
  X(6, over_speed, "The probe moved faster than speed_limit_m_per_s.", "Hold the stylus. If a wall pushed the stylus away, lower wall_stiffness_N_per_m. Then clear the fault.") \
  X(7, encoder_implausible, "A joint angle is far beyond its stop, an encoder count jumped, or an encoder count did not change although the motor current changed repeatedly. Counts were lost, or the arm description is wrong.", "Check the encoder plugs and the arm description, put the stylus into the inkwell, then clear the fault.") \
  X(8, host_silent, "The host was silent for longer than host_timeout_s while the force was on.", "Reconnect the companion, clear the fault, then switch the force on again.") \
  X(9, servo_overrun, "The control interrupt did not finish within its period.", "This fault is a firmware defect. Report it with the firmware version, then clear the fault.") \
  X(10, watchdog, "The watchdog restarted the board.", "Report this fault with the firmware version and the output of `inkwell fault`, then clear the fault.") \
  X(11, processor_fault, "The firmware switched the bridges off and restarted after a CPU fault exception.", "Report this fault with the firmware version and the output of `inkwell fault`, then clear the fault.") \
  X(12, not_finite, "A value in the control path was not a finite number.", "Check the arm parameters, restore the defaults, then clear the fault.") \
  X(13, samples_stale, "A motor current was not measured in a control period, or the supply and the gimbal were not measured for {samples_stale_ms} ms.", "Clear the fault. If it returns, reset the board and report it with the firmware version.") \
  X(14, crystal_failed, "The crystal stopped, or started too late. The motors were off until the board had restarted.", "Check the crystal, its two capacitors and their solder joints, then clear the fault. If it returns, replace the crystal.") \
  X(15, force_law, "The force law of this image returned a force that is not a finite number.", "Check the force law for a division by zero, the root of a negative number or a state that grows without limit, or restore the defaults of its parameters. Then clear the fault.") \
  X(16, motor_hot, "A motor is {motor_heat_beyond_percent} % above its thermal limit, although its current is reduced.", "Let the motor cool below {motor_heat_holds_back_percent} %. Check its wiring and its current sensor. If a test caused the fault, reduce its current. Then clear the fault.") \
  X(17, memory_damaged, "A bit of the firmware or of the active parameters has changed in memory.", "Reset the board. If the fault returns, flash the firmware again. If it still returns, replace the chip.") \
  X(18, motor_implausible, "The voltage, current and speed of a motor are inconsistent.", "Check the wires, the shunt amplifier and the encoder of the motor. A wrong motor resistance also causes this fault: measure it with `inkwell tune current-loop`. Put the stylus into the inkwell, then clear the fault.") \
  X(19, logic_supply_low, "The microcontroller's 3.3 V supply fell below 2.9 V.", "Check the regulator and its input voltage, and check the 3.3 V supply for a short circuit. Then clear the fault.") \
  X(20, supply_ripple, "The ripple of the bridge supply repeatedly exceeds {supply_ripple_V} V in either direction.", "Check the bulk capacitor at the bridges, the {supply_nominal_V} V supply and the plugs between capacitor and supply. Then clear the fault.") \
  X(21, encoder_wire, "An encoder count alternates between two values faster than the arm can move: one of the two signal wires is broken or stuck.", "Check the plug and both signal wires of the encoder, put the stylus into the inkwell, then clear the fault.") \
  X(22, bridge_wire, "The enable wire, the heartbeat wire or the wire of a half bridge does not follow the level of its pin, or the bridges are on when they must be off.", "Check the wires between chip and bridges for shorts to ground, to a supply or to another wire, and check the monostable of the heartbeat. Then clear the fault.") \
  X(23, analog_supply, "The analog supply VDDA differs by more than {analog_supply_percent} % from 3.3 V. VDDA is the reference of converters, amplifiers and potentiometers.", "Check the regulator, and check the ferrite bead and the capacitors of VDDA. Then clear the fault.") \
  X(24, self_test_failed, "The self-test failed for an item that the force needs.", "`inkwell self-test --last` names the item and its remedy. Then run `inkwell self-test` again: the fault is cleared if the test passes.") \
  X(25, inkwell_implausible, "The inkwell switch is closed, but the encoders show another arm position: counts were lost, or the switch or its wire is stuck.", "Check the inkwell switch, its wire and the encoder plugs. Clear the fault, take the stylus out of the inkwell and put it in again.") \
  X(26, main_loop_stalled, "The main loop, which serves USB, did not complete a pass for {main_loop_stalled_ms} ms.", "This fault is a firmware defect. Report it with the firmware version, then clear the fault.") \
  X(27, heartbeat_missed, "The bridges switched off without a command: no heartbeat of the control interrupt reached them in time.", "A debugger that halts the CPU causes this fault. Otherwise check the enable and heartbeat wires, the monostable, and its wires to the bridges and back to the chip. Then clear the fault. If these parts are correct, report the fault with the firmware version.") \
  X(28, current_jump, "A motor current changed in one control period by more than the winding inductance allows.", "Check the wires, the plugs, the bridge and the shunt amplifier of the motor. If the fault occurs when the force changes fast, tune the current loop with `inkwell tune current-loop`. Then clear the fault.") \
  X(29, usb_gone, "The USB connection was lost while the force was on: the cable was unplugged, the PC went to sleep, the device restarted, or the last USB/IP client disconnected.", "Plug the cable in. The window reconnects automatically; start other programs again. Clear the fault, then switch the force on again. If the cable was not unplugged, check cable, plug, hub and the VBUS wire.")

/// X(code, name, cause, remedy)
#define INKWELL_REFUSALS(X)                                                                                                       \
  X(0, accepted, "Accepted.", "Nothing to do.")                                                                                   \
  X(1, wrong_version, "The transaction has another protocol version.", "Use the companion version that matches the firmware, or flash the firmware version that matches the companion.") \
  X(2, wrong_length, "The length of the transaction does not match its number of entries.", "Use the companion version that matches the firmware.") \
  X(3, unknown_parameter, "The device has no parameter with this id.", "List the parameters with `inkwell parameters`.")                  \
  X(4, not_finite, "The value is not a finite number.", "Give a number in the parameter's range.")                                \
  X(5, out_of_range, "The value is outside the parameter's range.", "Give a number in the parameter's range.")                    \
  X(6, not_whole, "The value must be a whole number.", "Give a whole number.")                                                    \
  X(7, inconsistent, "The lower bound is not below the upper bound, or the box is too small for the sphere.", "Change both bounds in one transaction, and set the lower bound below the upper bound.") \
  X(8, given_twice, "The transaction contains a parameter twice.", "Give each parameter once.")                                \
  X(9, unknown_operation, "The device does not support this operation.", "Use the companion version that matches the firmware.")         \
  X(10, busy, "The previous transaction has not taken effect yet.", "Try again.")                                          \
  X(11, force_is_on, "The arm's geometry cannot change while the force is on.", "Switch the force off first.") \
  X(12, nothing_stored, "The board has no stored parameters to restore.", "Store the parameters with `inkwell parameters store`, or restore the defaults.") \
  X(13, not_the_driver, "Another program drives the arm.", "Exit the other program, or take the arm over from it.")
// clang-format on

enum class Fault : std::uint8_t {
#define X(code, name, ...) name = code,
  INKWELL_FAULTS(X)
#undef X
};

enum class Refusal : std::uint8_t {
#define X(code, name, ...) name = code,
  INKWELL_REFUSALS(X)
#undef X
};

struct CodeInfo {
  std::uint16_t code;
  std::string_view name;
  std::string_view cause;
  std::string_view remedy;
};

inline constexpr auto fault_table = std::to_array<CodeInfo>({
#define X(code, name, cause, remedy) {code, #name, cause, remedy},
    INKWELL_FAULTS(X)
#undef X
});

inline constexpr auto refusal_table = std::to_array<CodeInfo>({
#define X(code, name, cause, remedy) {code, #name, cause, remedy},
    INKWELL_REFUSALS(X)
#undef X
});

/// One more than the last code.
inline constexpr std::size_t fault_code_end = std::size_t{fault_table.back().code} + 1;

inline constexpr CodeInfo unknown_code{0xFFFF, "unknown", "The device sent a code that is unknown to this companion.",
                                       "Use the companion version that matches the firmware."};

namespace detail {
template <class Table>
constexpr const CodeInfo& look_up(const Table& table, std::uint16_t code) {
  for (const auto& row : table)
    if (row.code == code) return row;
  return unknown_code;
}
}  // namespace detail

constexpr const CodeInfo& info(Fault fault) { return detail::look_up(fault_table, static_cast<std::uint16_t>(fault)); }
constexpr const CodeInfo& info(Refusal refusal) {
  return detail::look_up(refusal_table, static_cast<std::uint16_t>(refusal));
}

}  // namespace inkwell::protocol
