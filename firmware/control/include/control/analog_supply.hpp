// Whether the converters' reference VDDA is what every reading takes it for. The shunt amplifiers and the
// potentiometers hang on it too: what is wrong with it is wrong by the same part in each current and in the supply's
// voltage.
//
// The chip has a voltage of its own, VREFINT, that does not follow its supply. Its reading is VREFINT over VDDA, so it
// falls as VDDA rises.
//
// How well that is known (STM32F405 data sheet, "Embedded internal reference voltage" and "ADC characteristics"): of
// all parts VREFINT lies within 1.18 V to 1.24 V, so 2.5 % to either side of 1.21 V. Each part has its own value,
// measured by its maker at 3.3 V within 10 mV, 0.3 %; heat from -40 C to 105 C moves it by 3 mV, 0.25 %, and the
// converter's own errors are 5 steps of 1500 at most, 0.3 %: below 1 % together. A regulator of 3.3 V keeps within 3 %.
// The bound of 5 % is beyond both, and an amplifier or a potentiometer that is fed with 5 % more or less still works as
// it should.
//
// Whole numbers only, for the main loop: each interrupt would save the floats of what it interrupts.
#pragma once

#include <cstdint>
#include <cstdlib>

#include <protocol/faults.hpp>

namespace inkwell::control {

constexpr float nominal_analog_supply_V = 3.3f;
/// What a converter of 12 bits shows of a voltage while VDDA is right.
constexpr std::uint16_t counts_at_nominal(float volts) {
  return static_cast<std::uint16_t>(volts / nominal_analog_supply_V * 4096.0f);
}

struct AnalogSupply {
  /// Of all parts, by the data sheet.
  static constexpr std::uint16_t minimum_counts = counts_at_nominal(1.18f), typical_counts = counts_at_nominal(1.21f),
                                 maximum_counts = counts_at_nominal(1.24f);
  /// What a maker's measurement may be off: 1 %.
  static constexpr std::uint16_t calibration_error_counts = typical_counts / 100;
  /// Looks in a row. What is shorter passes by before a current loop has followed.
  static constexpr std::uint32_t bearable_looks = 12;

  std::int32_t expected_counts = typical_counts;  ///< of VREFINT while VDDA is right
  std::int32_t bearable_per_mille = 0;            ///< part of VDDA by which it may be off
  std::uint32_t wrong_looks = 0;
};

/// `calibrated_counts` is what the maker has measured of this chip's VREFINT. One that no part can have was never
/// written, or was lost: then the typical value is taken, and as much more is borne as parts differ by.
constexpr AnalogSupply analog_supply(std::uint16_t calibrated_counts) {
  constexpr auto bearable_per_mille = static_cast<std::int32_t>(1000.0f * protocol::analog_supply_bearable + 0.5f);
  constexpr std::int32_t spread_per_mille =
      1000 * (AnalogSupply::maximum_counts - AnalogSupply::typical_counts) / AnalogSupply::typical_counts + 1;
  const bool is_possible = calibrated_counts >= AnalogSupply::minimum_counts - AnalogSupply::calibration_error_counts &&
                           calibrated_counts <= AnalogSupply::maximum_counts + AnalogSupply::calibration_error_counts;
  if (is_possible) return {.expected_counts = calibrated_counts, .bearable_per_mille = bearable_per_mille};
  return {.bearable_per_mille = bearable_per_mille + spread_per_mille};
}

/// Whether this reading of VREFINT says that VDDA is what it should be.
inline bool is_right(const AnalogSupply& supply, std::uint16_t reference_counts) {
  // VDDA over its nominal value is the expected reading over this one.
  const std::int32_t off_counts = std::abs(supply.expected_counts - reference_counts);
  return 1000 * off_counts <= supply.bearable_per_mille * reference_counts;
}

/// One look at the reading of VREFINT. True while it has been off for more than the bearable looks.
inline bool is_off(AnalogSupply& supply, std::uint16_t reference_counts) {
  if (is_right(supply, reference_counts))
    supply.wrong_looks = 0;
  else if (supply.wrong_looks <= AnalogSupply::bearable_looks)
    ++supply.wrong_looks;
  return supply.wrong_looks > AnalogSupply::bearable_looks;
}

/// VDDA, by this reading of VREFINT; 0 if that is 0, which no VDDA gives.
inline float analog_supply_V(const AnalogSupply& supply, std::uint16_t reference_counts) {
  if (reference_counts == 0) return 0.0f;
  return nominal_analog_supply_V * static_cast<float>(supply.expected_counts) / static_cast<float>(reference_counts);
}

}  // namespace inkwell::control
