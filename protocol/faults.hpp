// Faults and refusals, from protocol/tables/faults.toml and refusals.toml.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace inkwell::protocol {

/// A motor current above this multiple of the current limit raises a fault.
inline constexpr float over_current_ratio = 1.5f;
/// Largest age of the supply and gimbal measurements.
inline constexpr float samples_stale_s = 0.001f;
/// Longest allowed duration of a main loop pass. The shortest watchdog timeout is longer than main_loop_stalled_s.
inline constexpr float main_loop_stalled_s = 0.01f;
/// Largest deviation of the bridge supply from its mean, in either direction (supply_ripple.hpp).
inline constexpr float supply_ripple_V = 1.0f;
/// Largest relative deviation of the converter reference from its nominal value (analog_supply.hpp).
inline constexpr float analog_supply_tolerance = 0.05f;

struct CodeInfo {
  std::uint16_t code;
  std::string_view name;
  const char* cause;
  const char* remedy;
};

}  // namespace inkwell::protocol

#include <tables/faults.hpp>    // Fault, fault_table
#include <tables/refusals.hpp>  // Refusal, refusal_table

namespace inkwell::protocol {

/// Last fault code plus one.
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
