// Conditioning of raw samples.
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
  /// An offset above this bound indicates a broken sensor.
  static constexpr float plausible_A = 0.25f;
  /// Waiting time after the bridges are switched off. Winding currents decay within this time.
  static constexpr std::uint32_t patience_periods = periods_in(0.01f);

  Triple sum_A{};
  Triple offset_A{};
  std::uint32_t periods = 0;
  bool plausible = false;

  /// Adds one reading. The offsets and their plausibility are valid when measured() returns true.
  [[gnu::cold]] void measure(const Triple& current_A);
  bool measured() const { return periods >= duration_periods; }
};

// ---- supply --------------------------------------------------------------------------------------------

/// First-order low-pass filter with a time constant of 1.6 ms. The reciprocal of the filtered voltage converts volts to
/// duty cycles.
struct SupplyFilter {
  static constexpr float weight = 1.0f / 32.0f;
  /// Lower bound of the filtered voltage. The bound keeps the reciprocal finite if the supply is off.
  static constexpr float floor_V = 1.0f;
  static constexpr std::uint32_t stale_periods = periods_in(protocol::samples_stale_s);

  float supply_V = 0.0f;
  float per_V = 1.0f / floor_V;
  bool started = false;

  void add_sample(float sample_V);
};

// ---- switches ------------------------------------------------------------------------------------------

/// A new switch level must last 5 ms. One switch is filtered per control period.
struct SwitchFilter {
  static constexpr std::uint32_t settle_periods = periods_in(0.005f);
  static constexpr std::size_t count = protocol::switch_count;

  std::uint8_t closed = 0;
  std::array<std::uint8_t, count> changed_readings{};  ///< consecutive readings that differ from `closed`

  /// `turn` is the index of the switch to filter.
  void debounce(std::uint8_t switches, std::size_t turn);
};

// ---- inkwell -------------------------------------------------------------------------------------------

/// Encoder counts while the stylus is in the inkwell. Joint angles are computed relative to the inkwell counts.
struct InkwellReference {
  static constexpr std::uint32_t still_periods = periods_in(0.1f);
  /// Largest encoder change of a stationary arm.
  static constexpr std::int32_t still_counts = 1;
  /// Beyond this distance from the inkwell, the stylus cannot close the inkwell switch. The distance includes the
  /// travel of the stylus during debouncing.
  static constexpr float play_m = 0.02f;

  std::array<std::int32_t, 3> counts{};       ///< encoder counts since power-on, with the stylus in the inkwell
  std::array<std::int32_t, 3> rest_counts{};  ///< encoder counts at the last rest position of the arm
  std::uint32_t rested_periods = 0;
  bool valid = false;

  /// Stores the present counts as the inkwell reference after the switch has been closed and the arm has been
  /// stationary for 0.1 s. Each insertion of the stylus stores one reference. Returns true in the period in which the
  /// reference is stored.
  bool update(const std::array<std::int32_t, 3>& encoder_counts, bool inkwell_closed);

  /// After this call, the arm is unreferenced until the stylus is in the inkwell again. If `switch_in_doubt` is true,
  /// the inkwell switch must first open.
  constexpr void forget(bool switch_in_doubt) {
    counts = {};
    rested_periods = switch_in_doubt ? still_periods + 1 : 0;
    valid = false;
  }
};

}  // namespace inkwell::control
