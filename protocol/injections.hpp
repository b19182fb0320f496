// Injected faults for simulations, from protocol/tables/injections.toml.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace inkwell::protocol {

/// Failed part of the board or the arm. The rows of one part are consecutive.
enum class InjectionPart : std::uint8_t { wires, encoders, shunts, motors, bridges, supply, clocks, usb, core, memory };

/// Kind of location at which a fault is injected.
enum class InjectionLocation : std::uint8_t {
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

struct InjectionInfo {
  std::string_view name;
  InjectionPart part;
  InjectionLocation location;
  std::string_view unit;
  double minimum, maximum, otherwise;
  const char* help;
  constexpr bool has_amount() const { return minimum < maximum; }
};

}  // namespace inkwell::protocol

#include <tables/injections.hpp>  // InjectedFault, injection_table

namespace inkwell::protocol {

constexpr const InjectionInfo& info(InjectedFault fault) { return injection_table[static_cast<std::size_t>(fault)]; }

constexpr std::optional<InjectedFault> find_injection(std::string_view name) {
  for (std::size_t i = 0; i < injection_table.size(); ++i)
    if (injection_table[i].name == name) return static_cast<InjectedFault>(i);
  return std::nullopt;
}

namespace detail {
constexpr bool parts_are_in_order() {
  for (std::size_t i = 1; i < injection_table.size(); ++i)
    if (injection_table[i].part < injection_table[i - 1].part) return false;
  return true;
}
}  // namespace detail
static_assert(detail::parts_are_in_order(), "the rows of a part must be consecutive, in the order of InjectionPart");

}  // namespace inkwell::protocol
