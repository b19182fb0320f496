// Table of the signals that the scope can stream in every control period.
//
// Recordings use the names as column names. Most signals are transmitted as floats. Signals that change in every period
// and have a source with few bits are transmitted as scaled 16-bit integers.
//
// The signals of the image's force law follow the last row (docs/force-laws.md).
#pragma once

// protocol/tables/signals.toml contains the rows and the steps for a new signal.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "protocol/added_rows.hpp"
#include "protocol/each_axis.hpp"

namespace inkwell::protocol {

/// Encoding of a signal value in a scope frame.
enum class SignalWire : std::uint8_t {
  float32,        ///< 4 bytes, IEEE 754, little-endian
  current_int16,  ///< 2 bytes, in steps of `current_step_A`
  duty_int16,     ///< 2 bytes, in steps of `duty_step`
};

inline constexpr float current_step_A = 0.0002f;     ///< range +-6.5 A, finer than the ADC's 2 mA
inline constexpr float duty_step = 1.0f / 32767.0f;  ///< range +-1, finer than the timer's 1/1400

struct SignalInfo {
  std::uint8_t id;
  std::string_view name;
  std::string_view unit;
  SignalWire wire;
  const char* help = "";
};

}  // namespace inkwell::protocol

#include <tables/signals.hpp>  // Signal, signal_table

namespace inkwell::protocol {

inline constexpr std::size_t signal_count = signal_table.size();

inline constexpr std::size_t force_law_signals_maximum = 8;
static_assert(signal_count + force_law_signals_maximum <= 256, "a signal's id has eight bits");

/// Returns the table rows and the signals of a known force law.
inline KnownRows<SignalInfo, signal_count> known_signals() { return KnownRows(signal_table); }

constexpr const SignalInfo& info(Signal signal) {
  const auto index = static_cast<std::size_t>(signal);
  return index < signal_count ? signal_table[index] : known_signals()[index];
}
constexpr std::size_t row_count(Signal) { return signal_count; }
constexpr bool alike(const SignalInfo& a, const SignalInfo& b) { return a.unit == b.unit && a.wire == b.wire; }

/// Returns the signal of motor, joint or axis `axis` (0, 1 or 2). `rows` is the first of the three signals.
constexpr Signal of_axis(EachAxis<Signal> rows, std::size_t axis) { return rows[axis]; }
/// Returns the signal of motor, joint or axis `number` (1, 2 or 3, as in the row names).
constexpr Signal of_number(EachAxis<Signal> rows, int number) { return rows[static_cast<std::size_t>(number) - 1]; }

/// Values of one control period: table signals in table order, followed by the signals of the force law.
struct SignalValues {
  std::array<float, signal_count + force_law_signals_maximum> values;

  constexpr float& operator[](Signal signal) { return values[static_cast<std::size_t>(signal)]; }
  constexpr float operator[](Signal signal) const { return values[static_cast<std::size_t>(signal)]; }
};

constexpr std::size_t wire_size(SignalWire wire) { return wire == SignalWire::float32 ? 4 : 2; }

inline std::optional<Signal> find_signal(std::string_view name) {
  for (const auto& row : known_signals())
    if (row.name == name) return static_cast<Signal>(row.id);
  return std::nullopt;
}

}  // namespace inkwell::protocol
