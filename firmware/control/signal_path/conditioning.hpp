// Conditioning of raw samples: current sensor offsets, supply filter, switches, inkwell reference.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/control/signal_path/vector.hpp"
#include "protocol/faults.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

constexpr std::uint32_t periods_in(float time_s) {
  return static_cast<std::uint32_t>(time_s * static_cast<float>(protocol::servo_rate_Hz) + 0.5f);
}

// ---- current sensors -----------------------------------------------------------------------------------

/// Mean reading of the current sensors while the bridges are off.
struct CurrentOffsets {
  static constexpr std::uint32_t duration_periods = periods_in(0.1f);
  /// A healthy amplifier with a 1 % reference has an offset below 0.1 A. An offset above this bound indicates a broken
  /// sensor.
  static constexpr float plausible_A = 0.25f;
  /// Waiting time after the bridges are switched off. Winding currents decay within this time.
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

/// First-order low-pass filter with a time constant of 1.6 ms. The reciprocal of the filtered voltage converts volts to
/// duty cycles.
struct SupplyFilter {
  static constexpr float weight = 1.0f / 32.0f;
  /// Lower bound of the filtered voltage. The bound keeps the reciprocal finite if the supply is off. The bound is far
  /// below any voltage at which the bridges may be on.
  static constexpr float floor_V = 1.0f;
  static constexpr std::uint32_t stale_periods = periods_in(protocol::samples_stale_s);

  float supply_V = 0.0f;
  float per_V = 1.0f / floor_V;
  bool started = false;
};

void filter_supply(SupplyFilter& filter, float sample_V);

// ---- switches ------------------------------------------------------------------------------------------

/// Accepts a switch level that has not changed for 5 ms. One switch is filtered per control period.
struct SwitchFilter {
  static constexpr std::uint32_t settle_periods = periods_in(0.005f);
  static constexpr std::size_t count = protocol::switch_count;

  std::uint8_t closed = 0;
  std::array<std::uint8_t, count> changed_readings{};  ///< consecutive readings that differ from `closed`
};

/// `turn` is the switch of this period, 0..SwitchFilter::count - 1.
void debounce(SwitchFilter& filter, std::uint8_t switches, std::size_t turn);

// ---- inkwell -------------------------------------------------------------------------------------------

/// Encoder counts while the stylus is in the inkwell. Joint angles are computed relative to these counts.
struct InkwellReference {
  static constexpr std::uint32_t still_periods = periods_in(0.1f);
  /// Largest change of the encoder count at a stationary arm.
  static constexpr std::int32_t still_counts = 1;
  /// Beyond this distance from the inkwell, the stylus cannot close the inkwell switch. The switch closes shortly
  /// before the stylus is at rest. When a hand pulls the stylus out, debouncing reports the open switch 5 ms late.
  static constexpr float play_m = 0.02f;

  std::array<std::int32_t, 3> counts{};       ///< encoder counts since power-on, with the stylus in the inkwell
  std::array<std::int32_t, 3> rest_counts{};  ///< encoder counts at the last rest position of the arm
  std::uint32_t rested_periods = 0;
  bool valid = false;
};

/// After this call, the stylus must be inserted again. If `switch_in_doubt` is true, the switch must first be read as
/// open.
constexpr void forget(InkwellReference& reference, bool switch_in_doubt) {
  reference.counts = {};
  reference.rested_periods = switch_in_doubt ? InkwellReference::still_periods + 1 : 0;
  reference.valid = false;
}

/// Stores the present counts as the inkwell reference after the switch has been closed and the arm has been stationary
/// for 0.1 s. Each insertion of the stylus stores one reference. Returns true in the period in which the reference is
/// stored.
bool update_reference(InkwellReference& reference, const std::array<std::int32_t, 3>& encoder_counts,
                      bool inkwell_closed);

}  // namespace inkwell::control
