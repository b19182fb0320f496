// Table of injected faults for simulations: X(name, part, place, unit, minimum, maximum, otherwise, help).
//
// `part` is the heading in help texts, and `place` is the kind of location that a request must name. `otherwise` is the
// default amount. A fault without a range has no amount. Persistent faults can be healed, but single events, such as a
// slip or a flipped RAM bit, cannot be healed.
#pragma once

// To add an injected fault:
// (1) Add a row below the last row of its part.
// (2) Implement the fault in boards/virtual/injection/injector.cpp, with a class of the plant or a function of the
//     chip.
// (3) Add a row to docs/virtual-board.md, in the order of this table.
// (4) In host/lab/campaign/reasons.cpp, state why the fault may stay undetected. The compiler reports a missing case.
// (5) For a new kind of place, add a value to InjectionPlace, its parser to boards/virtual/injection/injection.cpp and
//     its names to protocol/injection_request.hpp.
//
// A new row changes the numbers of all later campaign cases. Help, control socket, command line, window and campaign
// use this table.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace inkwell::protocol {

/// Failed part of the board or the arm. The rows of one part are consecutive.
enum class InjectionPart : std::uint8_t { wires, encoders, shunts, motors, bridges, supply, clocks, usb, core, memory };

/// Kind of location at which a fault is injected.
enum class InjectionPlace : std::uint8_t {
  none,       ///< only one location exists
  motor,      ///< 1 to 3: the motor, its encoder and its shunt amplifier
  leg,        ///< half bridge 1A to 3B: motor number, and A or B for terminal + or -
  wire,       ///< a pin of the chip, such as PA0, or its name in the board description, such as encoders[0].a
  wires,      ///< two wires, separated by a plus sign
  exception,  ///< exception number; 16 is interrupt 0
  converter,  ///< ADC 1 to 3
  address,    ///< byte address; without one the seed selects it
};

inline constexpr double wire_spike_s = 2e-6;

// clang-format off
/// help_of() replaces a name in braces with its value.
#define INKWELL_INJECTIONS(X)                                                                                                      \
  X(wire_open, wires, wire, "", 0, 0, 0, "The wire is broken, and its input floats.")                                             \
  X(wire_low, wires, wire, "", 0, 0, 0, "The wire is shorted to ground.")                                                                \
  X(wire_high, wires, wire, "", 0, 0, 0, "The wire is shorted to 3.3 V.")                                                                \
  X(wire_frozen, wires, wire, "", 0, 0, 0, "The wire is stuck at its present level.")                                         \
  X(wires_shorted, wires, wires, "", 0, 0, 0, "Two wires are shorted. A low level overrides a high level; analog levels are averaged.")                           \
  X(wire_spikes, wires, wire, "1/s", 1, 100000, 1000, "Number of spikes of {wire_spike_us} us per second on a digital input, at random times.") \
  X(encoder_stuck, encoders, motor, "", 0, 0, 0, "The encoder disc does not turn with the motor.")                               \
  X(encoder_lost_counts, encoders, motor, "", 0.0001, 1, 0.01, "Fraction of the encoder counts that are lost at random.")     \
  X(encoder_slip, encoders, motor, "counts", -20000, 20000, 400, "Encoder counts by which the disc slips on its shaft.")              \
  X(shunt_offset, shunts, motor, "A", -10, 10, 0.5, "Offset of the shunt amplifier.")                          \
  X(shunt_gain, shunts, motor, "", 0, 10, 0.5, "Gain of the shunt amplifier, relative to its nominal gain.")                              \
  X(shunt_high, shunts, motor, "", 0, 0, 0, "The output of the shunt amplifier is at the upper rail.")                                  \
  X(shunt_low, shunts, motor, "", 0, 0, 0, "The output of the shunt amplifier is at the lower rail.")                                   \
  X(shunt_frozen, shunts, motor, "", 0, 0, 0, "The output of the shunt amplifier is frozen.")                                   \
  X(motor_open, motors, motor, "", 0, 0, 0, "No current flows in the motor: a lead or a brush is disconnected.")                                         \
  X(motor_shorted, motors, motor, "", 0.05, 1, 0.5, "Fraction of the winding that remains; the rest is shorted.")      \
  X(motor_hot, motors, motor, "K", 0, 300, 100, "Temperature rise of the motor, which increases its resistance and reduces its torque.")                      \
  X(leg_high, bridges, leg, "", 0, 0, 0, "The upper switch is shorted. The bridge trips when the lower switch turns on.")              \
  X(leg_low, bridges, leg, "", 0, 0, 0, "The lower switch is shorted. The bridge trips when the upper switch turns on.")               \
  X(leg_open, bridges, leg, "", 0, 0, 0, "Both switches are open. Only the diodes conduct.")                                                \
  X(leg_slow, bridges, leg, "s", 0, 0.00005, 0.000001, "Additional switching delay of the half bridge.")                     \
  X(bridge_fault, bridges, none, "", 0, 0, 0, "A bridge pulls the fault wire low.")                                                    \
  X(supply_sag, supply, none, "V", 0, 18, 10, "Voltage to which the bridge supply falls.")                                          \
  X(supply_spike, supply, none, "V", 18, 36, 30, "Voltage to which the bridge supply rises.")                                       \
  X(supply_cut, supply, none, "", 0, 0, 0, "The bridge supply is disconnected.")                                                   \
  X(supply_ripple, supply, none, "V", 0, 6, 3, "Amplitude of a 100 Hz ripple on the bridge supply.")  \
  X(logic_sag, supply, none, "V", 0, 3.3, 2, "Voltage to which the 3.3 V supply and VDDA fall.")                                 \
  X(analog_sag, supply, none, "V", 0, 3.6, 3, "Voltage of VDDA, the reference of converters and amplifiers. The 3.3 V supply does not change.")                    \
  X(crystal_stop, clocks, none, "", 0, 0, 0, "The crystal stops.")                                                                 \
  X(crystal_drift, clocks, none, "ppm", -10000, 10000, 5000, "Deviation of the crystal from its nominal frequency.")                   \
  X(usb_cut, usb, none, "", 0, 0, 0, "The cable is unplugged.")                                                                          \
  X(host_silent, usb, none, "", 0, 0, 0, "The host neither polls nor sends, but bus frames continue.")                                         \
  X(core_stalled, core, none, "s", 0, 1000, 1, "Time for which the core is stopped while the peripherals continue.")                                   \
  X(core_halted, core, none, "s", 0, 1000, 1, "Time for which a debug probe halts the core.")                                         \
  X(main_loop_stalled, core, none, "s", 0, 1000, 1, "Time for which the main loop hangs while interrupts continue.")                          \
  X(program_astray, core, address, "", 0, 0, 0, "Address to which the program counter jumps. Default: an address in flash.")               \
  X(exception_lost, core, exception, "", 0, 0, 0, "An interrupt request is lost.")                                          \
  X(exception_late, core, exception, "cycles", 1, 1000000, 4200, "Delay of an interrupt in cycles.")                        \
  X(adc_stopped, core, converter, "", 0, 0, 0, "A converter does not start conversions.")                                       \
  X(dma_stopped, core, none, "", 0, 0, 0, "The DMA controller does not serve requests.")                                                    \
  X(ram_bit, memory, address, "", -1, 7, -1, "Bit that flips in the RAM byte; -1 chooses the bit from the seed.")                               \
  X(flash_bit, memory, address, "", -1, 7, -1, "Bit that flips in the flash byte; -1 chooses the bit from the seed. Healing restores the bit.")
// clang-format on

/// The value of an enumerator is the index of its row.
enum class InjectedFault : std::uint8_t {
#define X(name, ...) name,
  INKWELL_INJECTIONS(X)
#undef X
};

struct InjectionInfo {
  std::string_view name;
  InjectionPart part;
  InjectionPlace place;
  std::string_view unit;
  double minimum, maximum, otherwise;
  std::string_view help;
  constexpr bool has_amount() const { return minimum < maximum; }
};

inline constexpr auto injection_table = std::to_array<InjectionInfo>({
#define X(name, part, place, unit, minimum, maximum, otherwise, help) \
  {#name, InjectionPart::part, InjectionPlace::place, unit, minimum, maximum, otherwise, help},
    INKWELL_INJECTIONS(X)
#undef X
});

constexpr const InjectionInfo& info(InjectedFault fault) { return injection_table[static_cast<std::size_t>(fault)]; }

constexpr std::optional<InjectedFault> find_injection(std::string_view name) {
  for (std::size_t i = 0; i < injection_table.size(); ++i)
    if (injection_table[i].name == name) return static_cast<InjectedFault>(i);
  return std::nullopt;
}

namespace detail {
constexpr bool injections_make_sense() {
  for (const auto& row : injection_table)
    if (row.has_amount() && (row.otherwise < row.minimum || row.otherwise > row.maximum)) return false;
  return true;
}
constexpr bool parts_are_in_order() {
  for (std::size_t i = 1; i < injection_table.size(); ++i)
    if (injection_table[i].part < injection_table[i - 1].part) return false;
  return true;
}
}  // namespace detail
static_assert(detail::injections_make_sense(), "a default amount is outside its range");
static_assert(detail::parts_are_in_order(), "the rows of a part must be consecutive, in the order of InjectionPart");

}  // namespace inkwell::protocol
