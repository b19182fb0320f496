// Making raw samples trustworthy: offsets of the current sensors, supply filter, switches, inkwell reference.
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
  /// An amplifier with a reference of 1 % and its own offset stays within 0.1 A; more is a broken sensor.
  static constexpr float plausible_A = 0.25f;
  /// Longer than a current lasts in a winding whose bridge was switched off.
  static constexpr std::uint32_t patience_periods = periods_in(0.01f);

  Triple sum_A{};
  Triple offset_A{};
  std::uint32_t periods = 0;
  bool plausible = false;

  bool measured() const { return periods >= duration_periods; }
};

/// Adds one reading; the offsets, and whether they are plausible, are valid once measured() is true.
[[gnu::cold]] void measure_offsets(CurrentOffsets& offsets, const Triple& current_A);

// ---- supply --------------------------------------------------------------------------------------------

/// First-order low-pass of 1.6 ms, and the reciprocal that turns volts into duty.
struct SupplyFilter {
  static constexpr float weight = 1.0f / 32.0f;
  /// Keeps the reciprocal finite when the supply is absent; far below any supply that is allowed to drive.
  static constexpr float floor_V = 1.0f;
  static constexpr std::uint32_t stale_periods = periods_in(protocol::samples_stale_s);

  float supply_V = 0.0f;
  float per_V = 1.0f / floor_V;
  bool started = false;
};

void filter_supply(SupplyFilter& filter, float sample_V);

// ---- switches ------------------------------------------------------------------------------------------

/// Takes over what a switch has shown without change for 5 ms, whatever the others do. They take turns.
struct SwitchFilter {
  static constexpr std::uint32_t settle_periods = periods_in(0.005f);
  static constexpr std::size_t count = protocol::switch_count;

  std::uint8_t closed = 0;
  std::array<std::uint8_t, count> looks{};  ///< in a row in which a switch showed something else
};

/// `turn`: whose turn it is, 0..SwitchFilter::count - 1.
void debounce(SwitchFilter& filter, std::uint8_t switches, std::size_t turn);

// ---- inkwell -------------------------------------------------------------------------------------------

/// Counts of the encoders in the inkwell: what joint angles are measured from.
struct InkwellReference {
  static constexpr std::uint32_t still_periods = periods_in(0.1f);
  /// An encoder may dither by this while the arm counts as still.
  static constexpr std::int32_t still_counts = 1;
  /// Farther from the inkwell, at the stylus, its switch is not closed by the stylus: it closes a little before the
  /// stylus rests, and is believed 5 ms late when a hand pulls it out.
  static constexpr float play_m = 0.02f;

  std::array<std::int32_t, 3> counts{};       ///< in the inkwell, since power-up
  std::array<std::int32_t, 3> rest_counts{};  ///< where the arm has been still
  std::uint32_t rested_periods = 0;
  bool valid = false;
};

/// The stylus has to be put in once more; `switch_in_doubt`: the switch has to be seen open before that.
constexpr void forget(InkwellReference& reference, bool switch_in_doubt) {
  reference.counts = {};
  reference.rested_periods = switch_in_doubt ? InkwellReference::still_periods + 1 : 0;
  reference.valid = false;
}

/// Takes the present counts as those of the inkwell once the switch has been closed and the arm still for
/// 0.1 s; once for each time that the stylus is put in. Returns true in the period in which that happens.
bool update_reference(InkwellReference& reference, const std::array<std::int32_t, 3>& encoder_counts,
                      bool inkwell_closed);

}  // namespace inkwell::control
