// Faults and refusals: every code with its cause and its remedy, in the words a user sees.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace inkwell::protocol {

/// A motor current is too much beyond so many times its limit.
inline constexpr float over_current_ratio = 1.5f;
/// Supply and gimbal are not known any more if they were not measured for longer.
inline constexpr float samples_stale_s = 0.001f;
/// The main loop did not come round for longer. The watchdog's shortest time is longer than that.
inline constexpr float main_loop_stalled_s = 0.01f;
/// The supply of the bridges swings by more to either side of its mean (control/supply_ripple.hpp).
inline constexpr float supply_ripple_V = 1.0f;
/// The converters' reference is off by a larger part of what it should be (control/analog_supply.hpp).
inline constexpr float analog_supply_bearable = 0.05f;

// clang-format off
/// X(code, name, cause, remedy). A name in braces stands for that figure: device::fault_text() writes it.
#define INKWELL_FAULTS(X)                                                                                                         \
  X(0, none, "No fault.", "Nothing to do.")                                                                                       \
  X(1, bridge_fault, "A bridge reported over-current, over-temperature or under-voltage.", "Check the motor wiring for a short, let the bridges cool, then clear the fault.") \
  X(2, supply_low, "The supply of the bridges is below {supply_minimum_V} V.", "Check the {supply_nominal_V} V supply and its fuse, then clear the fault.")       \
  X(3, supply_high, "The supply of the bridges is above {supply_maximum_V} V.", "Use a supply of {supply_nominal_V} V; if it rises while the arm is moved fast, add bulk capacitance. Then clear the fault.") \
  X(4, current_sensor, "A current sensor does not read zero while its bridge is off.", "Check the shunt amplifier of that motor and its {shunt_amplifier_offset_V} V reference, then clear the fault. If it was there from the start, reset the board: it measures them anew.") \
  X(5, over_current, "A motor current exceeded {over_current_percent} % of its limit, or what its sensor can measure.", "Check the motor wiring and lower the gains of the current loop, then clear the fault.") \
  X(6, over_speed, "The probe moved faster than speed_limit_m_per_s.", "Hold the stylus, lower wall_stiffness_N_per_m if it was thrown out of a wall, then clear the fault.") \
  X(7, encoder_implausible, "A joint angle lies far beyond its stop, an encoder jumped, or stands still although its motor presses otherwise again and again: counts were lost, or the arm description is wrong.", "Check the encoder plugs and the arm's description, put the stylus into the inkwell, then clear the fault.") \
  X(8, host_silent, "The host was silent for longer than host_timeout_s while the force was on.", "Reconnect the companion, clear the fault, then switch the force on again.") \
  X(9, servo_overrun, "The control interrupt did not finish within its period.", "Report this with the firmware version: it is a defect of the firmware. Then clear the fault.") \
  X(10, watchdog, "The board was restarted by its watchdog.", "Report this with the firmware version and what `inkwell fault` says, then clear the fault.") \
  X(11, processor_fault, "The processor met a fault; it switched the bridges off and restarted.", "Report this with the firmware version and what `inkwell fault` says, then clear the fault.") \
  X(12, not_finite, "A value in the control path was not a finite number.", "Check the parameters of the arm, load the defaults, then clear the fault.") \
  X(13, samples_stale, "A motor's current was not measured in a control period, or supply and gimbal for {samples_stale_ms} ms.", "Clear the fault. If it comes back, reset the board and report this with the firmware version.") \
  X(14, crystal_failed, "The board's crystal stopped, or swung late; the motors were off until the board had started anew.", "Check the crystal, its two capacitors and their joints, then clear the fault. If it comes back, replace the crystal.") \
  X(15, force_law, "The force law of this image gave a force that is no finite number.", "Look in the force law for a division by zero, the root of a negative number or a state that grows without end, or put its parameters back to their defaults. Then clear the fault.") \
  X(16, motor_hot, "A motor is {motor_heat_beyond_percent} % hotter than it bears, although its current is held back.", "Let it cool below {motor_heat_holds_back_percent} %; while it does, check its wiring and its current sensor, or what tested it. Then clear the fault.") \
  X(17, memory_damaged, "A bit of the firmware, or of the parameters that it works with, has changed by itself in memory.", "Reset the board. If it comes back, flash the firmware anew; if it still comes back, replace the chip.") \
  X(18, motor_implausible, "A motor's voltage, current and speed do not belong together.", "Check the motor's wires, its shunt amplifier and its encoder. `inkwell tune current-loop` measures the motor's resistance, by which this is judged. Put the stylus into the inkwell, then clear the fault.") \
  X(19, logic_supply_low, "The chip's own supply of 3.3 V has fallen below 2.9 V.", "Check the board's regulator and what it is fed from, and whether something shorts the 3.3 V. Then clear the fault.") \
  X(20, supply_ripple, "The supply of the bridges swings by more than {supply_ripple_V} V to either side, again and again.", "Check the bulk capacitor at the bridges, the {supply_nominal_V} V supply and the plugs between the two. Then clear the fault.") \
  X(21, encoder_wire, "An encoder's count goes to and fro by one and no further, faster than anything can shake the arm: one of its two signal wires is dead.", "Check that encoder's plug and both of its signal wires, put the stylus into the inkwell, then clear the fault.") \
  X(22, bridge_wire, "The wire of enable, heartbeat or a leg of the bridges is not at the level that the chip gives it, or the bridges are held on when they should be off.", "Look for a wire between the chip and the bridges that touches ground, a supply or another wire, and at the heartbeat's monostable. Then clear the fault.") \
  X(23, analog_supply, "The converters' reference VDDA, which feeds amplifiers and potentiometers too, is more than {analog_supply_percent} % off its 3.3 V.", "Check the board's regulator, and the ferrite and the capacitors of VDDA. Then clear the fault.") \
  X(24, self_test_failed, "The self-test has found something without which there is no force.", "`inkwell self-test --last` names it and says what to do. Then `inkwell self-test` tests again; the fault goes if it passes.") \
  X(25, inkwell_implausible, "The inkwell's switch is closed, but by the encoders the arm is somewhere else: counts were lost, or the switch or its wire is stuck.", "Check the inkwell's switch, its wire and the encoder plugs. Clear the fault, take the stylus out of the inkwell and put it in once more.") \
  X(26, main_loop_stalled, "The main loop, which speaks with the host, did not come round for {main_loop_stalled_ms} ms.", "Report this with the firmware version: it is a defect of the firmware. Then clear the fault.") \
  X(27, heartbeat_missed, "The bridges let go by themselves: no heartbeat of the control interrupt reached them in time.", "A debugger that halts the processor does that. Otherwise check the wires of enable and heartbeat, the monostable, and its wires to the bridges and back to the chip. Then clear the fault. If nothing is wrong there, report it with the firmware version.") \
  X(28, current_jump, "A motor's current changed at once by more than its winding lets it.", "Check that motor's wires and plugs, its bridge and its shunt amplifier. If it comes as the force changes fast, measure the gains of the current loop anew with `inkwell tune current-loop`. Then clear the fault.") \
  X(29, usb_gone, "USB went away while the force was on: its cable was pulled, the PC went to sleep, the device was started anew, or the last program that used it over USB/IP ended.", "Plug the cable in; a window connects by itself, other programs are started again. Clear the fault, then switch the force on again. If nobody pulled it, check cable, plug and hub, and the wire that tells of the cable's power.")

/// X(code, name, cause, remedy)
#define INKWELL_REFUSALS(X)                                                                                                       \
  X(0, accepted, "Accepted.", "Nothing to do.")                                                                                   \
  X(1, wrong_version, "The transaction was written for another version of the protocol.", "Use the companion that belongs to this firmware, or flash the firmware that belongs to this companion.") \
  X(2, wrong_length, "The transaction's length does not fit its number of entries.", "Use the companion that belongs to this firmware.") \
  X(3, unknown_parameter, "The device has no such parameter.", "List the parameters with `inkwell parameters`.")                  \
  X(4, not_finite, "The value is not a finite number.", "Give a number in the parameter's range.")                                \
  X(5, out_of_range, "The value is outside the parameter's range.", "Give a number in the parameter's range.")                    \
  X(6, not_whole, "The value must be a whole number.", "Give a whole number.")                                                    \
  X(7, inconsistent, "The lower bound is not below the upper bound, or the box is too small for the sphere.", "Change both bounds in one transaction, the lower one below the upper one.") \
  X(8, given_twice, "The parameter stands twice in the transaction.", "Give each parameter once.")                                \
  X(9, unknown_operation, "The device does not know this operation.", "Use the companion that belongs to this firmware.")         \
  X(10, busy, "The transaction before this one has not taken effect yet.", "Try again.")                                          \
  X(11, force_is_on, "The arm's geometry cannot change while the force is on.", "Switch the force off first.") \
  X(12, nothing_stored, "The board has stored nothing that could be restored.", "Store the parameters with `inkwell parameters store`, or load the defaults.") \
  X(13, not_the_driver, "Another program drives the arm.", "End that program, or take the arm over from it.")
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

inline constexpr CodeInfo unknown_code{0xFFFF, "unknown", "The device sent a code that this companion does not know.",
                                       "Use the companion that belongs to this firmware."};

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
