// Conditioning of raw samples: current sensor offsets, supply filter, switches, inkwell reference.
#pragma once

#include <array>
#include <cstdint>

#include <control/vector.hpp>
#include <protocol/faults.hpp>
#include <protocol/reports.hpp>

namespace inkwell::control {

constexpr std::uint32_t periods_in(float time_s) {
  return static_cast<std::uint32_t>(time_s * static_cast<float>(protocol::servo_rate_Hz) + 0.5f);
}

// ---- current sensors -----------------------------------------------------------------------------------

/// Mean reading of the current sensors while the bridges are off.
struct CurrentOffsets {
  static constexpr std::uint32_t duration_periods = periods_in(0.1f);
  /// An amplifier with a 1 % reference and its offset stays within 0.1 A. A larger offset means a broken sensor.
  static constexpr float plausible_A = 0.25f;
  /// Longer than the current decay in a winding after its bridge was switched off.
  static constexpr std::uint32_t patience_periods = periods_in(0.01f);

  Triple sum_A{};
  Triple offset_A{};
  std::uint32_t periods = 0;
  bool plausible = false;

  bool measured() const { return periods >= duration_periods; }
};

/// Adds one reading. The offsets and their plausibility are valid once measured() is true.
[[gnu::cold]] void measure_offsets(CurrentOffsets& offsets, const Triple& current_A);

// ---- supply --------------------------------------------------------------------------------------------

/// First-order low-pass of 1.6 ms, and the reciprocal that converts volts to duty cycles.
struct SupplyFilter {
  static constexpr float weight = 1.0f / 32.0f;
  /// Lower bound of the voltage, so that the reciprocal is finite without a supply. The bound is far below any voltage
  /// at which the bridges may be on.
  static constexpr float floor_V = 1.0f;
  static constexpr std::uint32_t stale_periods = periods_in(protocol::samples_stale_s);

  float supply_V = 0.0f;
  float per_V = 1.0f / floor_V;
  bool started = false;
};

void filter_supply(SupplyFilter& filter, float sample_V);

// ---- switches ------------------------------------------------------------------------------------------

/// Accepts a switch level that has not changed for 5 ms. The switches are filtered separately and take turns.
struct SwitchFilter {
  static constexpr std::uint32_t settle_periods = periods_in(0.005f);
  static constexpr std::size_t count = protocol::switch_count;

  std::uint8_t closed = 0;
  std::array<std::uint8_t, count> looks{};  ///< consecutive readings that differ from `closed`
};

/// `turn` is the switch of this period, 0..SwitchFilter::count - 1.
void debounce(SwitchFilter& filter, std::uint8_t switches, std::size_t turn);

// ---- inkwell -------------------------------------------------------------------------------------------

/// Encoder counts in the inkwell, from which joint angles are measured.
struct InkwellReference {
  static constexpr std::uint32_t still_periods = periods_in(0.1f);
  /// Largest encoder dither of a stationary arm.
  static constexpr std::int32_t still_counts = 1;
  /// Beyond this distance from the inkwell, the stylus cannot close the inkwell switch. The switch closes shortly
  /// before the stylus rests. The debouncing accepts an opened switch 5 ms late when a hand pulls the stylus out.
  static constexpr float play_m = 0.02f;

  std::array<std::int32_t, 3> counts{};       ///< encoder counts in the inkwell, since power-on
  std::array<std::int32_t, 3> rest_counts{};  ///< encoder counts at the last rest position of the arm
  std::uint32_t rested_periods = 0;
  bool valid = false;
};

/// Requires the stylus to be inserted again. With `switch_in_doubt` the switch must first be read as open.
constexpr void forget(InkwellReference& reference, bool switch_in_doubt) {
  reference.counts = {};
  reference.rested_periods = switch_in_doubt ? InkwellReference::still_periods + 1 : 0;
  reference.valid = false;
}

/// Stores the present counts as the inkwell reference after the switch has been closed and the arm stationary for 0.1
/// s. Each insertion of the stylus stores one reference. Returns true in the period in which the reference is stored.
bool update_reference(InkwellReference& reference, const std::array<std::int32_t, 3>& encoder_counts,
                      bool inkwell_closed);

}  // namespace inkwell::control
