// The table of what can be made to fail in a simulation: X(name, part, place, unit, minimum, maximum, otherwise, help).
//
// `part` is under what heading it stands, `place` is what a fault is put into, and the last number is its amount unless
// another is given. A fault with no range takes no amount. Lasting faults can be healed; what has happened once (a
// slip, a flipped bit of RAM) stays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace inkwell::protocol {

/// What of board and arm fails: the rows of one part follow each other.
enum class InjectionPart : std::uint8_t { wires, encoders, shunts, motors, bridges, supply, clocks, usb, core, memory };

/// What a fault is put into.
enum class InjectionPlace : std::uint8_t {
  none,       ///< there is one only
  motor,      ///< 1 to 3, with its encoder and its shunt amplifier
  leg,        ///< 1A to 3B: motor, and terminal + or -
  wire,       ///< a pin of the chip: PA0, or what the board's facts call it, such as encoders[0].a
  wires,      ///< two of them, with a plus between
  exception,  ///< by number: 16 is interrupt 0
  converter,  ///< ADC 1 to 3
  address,    ///< of a byte; a place by the seed unless given
};

inline constexpr double wire_spike_s = 2e-6;

// clang-format off
/// A name in braces stands for that figure: help_of() writes it.
#define INKWELL_INJECTIONS(X)                                                                                                      \
  X(wire_open, wires, wire, "", 0, 0, 0, "The wire is broken: what it drives floats.")                                             \
  X(wire_low, wires, wire, "", 0, 0, 0, "The wire touches ground.")                                                                \
  X(wire_high, wires, wire, "", 0, 0, 0, "The wire touches 3.3 V.")                                                                \
  X(wire_frozen, wires, wire, "", 0, 0, 0, "The wire stays as it is, whatever drives it.")                                         \
  X(wires_shorted, wires, wires, "", 0, 0, 0, "Two wires touch: low wins, analogue ones meet half-way.")                           \
  X(wire_spikes, wires, wire, "1/s", 1, 100000, 1000, "So many spikes of {wire_spike_us} us on a digital input, at random times.") \
  X(encoder_stuck, encoders, motor, "", 0, 0, 0, "The encoder's disc stands while the motor turns.")                               \
  X(encoder_lost_counts, encoders, motor, "", 0.0001, 1, 0.01, "So large a share of the encoder's counts is lost, at random.")     \
  X(encoder_slip, encoders, motor, "counts", -20000, 20000, 400, "The encoder's disc slips on its shaft by so much.")              \
  X(shunt_offset, shunts, motor, "A", -10, 10, 0.5, "The shunt amplifier reads so much more than flows.")                          \
  X(shunt_gain, shunts, motor, "", 0, 10, 0.5, "The shunt amplifier reads so many times what flows.")                              \
  X(shunt_high, shunts, motor, "", 0, 0, 0, "The shunt amplifier's output is at the upper rail.")                                  \
  X(shunt_low, shunts, motor, "", 0, 0, 0, "The shunt amplifier's output is at the lower rail.")                                   \
  X(shunt_frozen, shunts, motor, "", 0, 0, 0, "The shunt amplifier's output stays where it is.")                                   \
  X(motor_open, motors, motor, "", 0, 0, 0, "No current flows: a lead or a brush is off.")                                         \
  X(motor_shorted, motors, motor, "", 0.05, 1, 0.5, "So large a share of the motor's turns is left, the others are shorted.")      \
  X(motor_hot, motors, motor, "K", 0, 300, 100, "The motor is so much hotter: more resistance, less torque.")                      \
  X(leg_high, bridges, leg, "", 0, 0, 0, "The upper switch has fused; the bridge trips when the lower one joins it.")              \
  X(leg_low, bridges, leg, "", 0, 0, 0, "The lower switch has fused; the bridge trips when the upper one joins it.")               \
  X(leg_open, bridges, leg, "", 0, 0, 0, "Neither switch conducts; the diodes do.")                                                \
  X(leg_slow, bridges, leg, "s", 0, 0.00005, 0.000001, "The switches conduct so much later than they should.")                     \
  X(bridge_fault, bridges, none, "", 0, 0, 0, "A bridge pulls the fault wire.")                                                    \
  X(supply_sag, supply, none, "V", 0, 18, 10, "The source of the bridges falls to this.")                                          \
  X(supply_spike, supply, none, "V", 18, 36, 30, "The source of the bridges rises to this.")                                       \
  X(supply_cut, supply, none, "", 0, 0, 0, "The source of the bridges is gone.")                                                   \
  X(supply_ripple, supply, none, "V", 0, 6, 3, "The source of the bridges swings by so much to either side, 100 times a second.")  \
  X(logic_sag, supply, none, "V", 0, 3.3, 2, "The chip's 3.3 V fall to this, and VDDA with them.")                                 \
  X(analog_sag, supply, none, "V", 0, 3.6, 3, "VDDA alone is at this: reference of converters and amplifiers.")                    \
  X(crystal_stop, clocks, none, "", 0, 0, 0, "The crystal stops.")                                                                 \
  X(crystal_drift, clocks, none, "ppm", -10000, 10000, 5000, "The crystal swings so much faster than its name.")                   \
  X(usb_cut, usb, none, "", 0, 0, 0, "The cable is out.")                                                                          \
  X(host_silent, usb, none, "", 0, 0, 0, "The host asks and sends nothing; frames go on.")                                         \
  X(core_stalled, core, none, "s", 0, 1000, 1, "The core stands for so long; all else goes on.")                                   \
  X(core_halted, core, none, "s", 0, 1000, 1, "A debug probe halts the core for so long.")                                         \
  X(main_loop_stalled, core, none, "s", 0, 1000, 1, "The main loop hangs for so long; interrupts go on.")                          \
  X(program_astray, core, address, "", 0, 0, 0, "The program counter is thrown there, into the flash unless given.")               \
  X(exception_lost, core, exception, "", 0, 0, 0, "An interrupt never reaches the core.")                                          \
  X(exception_late, core, exception, "cycles", 1, 1000000, 4200, "An interrupt comes so many cycles late.")                        \
  X(adc_stopped, core, converter, "", 0, 0, 0, "A converter starts no conversion any more.")                                       \
  X(dma_stopped, core, none, "", 0, 0, 0, "The DMA takes no request any more.")                                                    \
  X(ram_bit, memory, address, "", -1, 7, -1, "A bit of a byte of RAM flips; -1 is one by the seed.")                               \
  X(flash_bit, memory, address, "", -1, 7, -1, "A bit of the flash flips; healing writes it back.")
// clang-format on

/// Its value is its place in the table.
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
static_assert(detail::injections_make_sense(),
              "an amount that is taken unless another is given lies outside its range");
static_assert(detail::parts_are_in_order(), "the rows of a part must stand together, in the order of InjectionPart");

}  // namespace inkwell::protocol
