// Checks VDDA, the reference voltage of the converters. The shunt amplifiers and the potentiometers are also connected
// to VDDA. A VDDA error therefore scales all measured currents and voltages by the same factor.
//
// The internal reference voltage VREFINT does not depend on VDDA. The reading of VREFINT therefore falls as VDDA rises.
//
// The following errors are from the STM32F405 data sheet ("Embedded internal reference voltage", "ADC
// characteristics"). VREFINT is between 1.18 V and 1.24 V for all chips (1.21 V with a tolerance of 2.5 %). The
// manufacturer measures VREFINT of each chip at a VDDA of 3.3 V with an error of 10 mV (0.3 %). Between -40 C and 105
// C, VREFINT changes by 3 mV (0.25 %). The converter error is at most 5 counts of 1500 (0.3 %).
//
// Measurement, temperature and converter errors add up to less than 1 %. The error of a 3.3 V regulator is at most 3 %.
// The bound of 5 % exceeds the sum of measurement error and regulator error. Amplifiers and potentiometers work with a
// supply error of 5 %.
//
// The check uses only integers. If the main loop used floats, every interrupt would save the floating-point registers.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "protocol/faults.hpp"

namespace inkwell::control {

constexpr float nominal_analog_supply_V = 3.3f;
/// Returns the ADC counts of a voltage at VDDA = 3.3 V.
constexpr std::uint16_t counts_at_nominal(float volts) {
  return static_cast<std::uint16_t>(volts / nominal_analog_supply_V * 4096.0f);
}

struct AnalogSupply {
  /// Data sheet range of VREFINT for all chips.
  static constexpr std::uint16_t minimum_counts = counts_at_nominal(1.18f), typical_counts = counts_at_nominal(1.21f),
                                 maximum_counts = counts_at_nominal(1.24f);
  /// Largest calibration error of VREFINT: 1 %.
  static constexpr std::uint16_t calibration_error_counts = typical_counts / 100;
  /// Number of tolerated consecutive wrong readings. The current loops do not react to a disturbance of this duration.
  static constexpr std::uint32_t tolerated_readings = 12;

  std::int32_t expected_counts = typical_counts;  ///< reading of VREFINT at nominal VDDA
  std::int32_t tolerance_per_mille = 0;           ///< tolerated deviation of VDDA
  std::uint32_t wrong_readings = 0;

  /// Returns true if this reading of VREFINT corresponds to a valid VDDA.
  bool is_right(std::uint16_t reference_counts) const {
    // VDDA / nominal VDDA = expected reading / this reading.
    const std::int32_t off_counts = std::abs(expected_counts - reference_counts);
    return 1000 * off_counts <= tolerance_per_mille * reference_counts;
  }

  /// Checks one reading of VREFINT. Returns true after more than `tolerated_readings` consecutive wrong readings.
  bool detect_supply_error(std::uint16_t reference_counts) {
    if (is_right(reference_counts))
      wrong_readings = 0;
    else if (wrong_readings <= tolerated_readings)
      ++wrong_readings;
    return wrong_readings > tolerated_readings;
  }

  /// Returns VDDA for a VREFINT reading, or 0 for the impossible reading 0.
  float analog_supply_V(std::uint16_t reference_counts) const {
    if (reference_counts == 0) return 0.0f;
    return nominal_analog_supply_V * static_cast<float>(expected_counts) / static_cast<float>(reference_counts);
  }
};

/// `calibrated_counts` is the manufacturer's measurement of VREFINT for this chip. Chips without a valid calibration
/// value use the typical value and a larger tolerance.
constexpr AnalogSupply analog_supply(std::uint16_t calibrated_counts) {
  constexpr auto tolerance_per_mille = static_cast<std::int32_t>(1000.0f * protocol::analog_supply_tolerance + 0.5f);
  constexpr std::int32_t spread_per_mille =
      1000 * (AnalogSupply::maximum_counts - AnalogSupply::typical_counts) / AnalogSupply::typical_counts + 1;
  const bool is_possible = calibrated_counts >= AnalogSupply::minimum_counts - AnalogSupply::calibration_error_counts &&
                           calibrated_counts <= AnalogSupply::maximum_counts + AnalogSupply::calibration_error_counts;
  if (is_possible) return {.expected_counts = calibrated_counts, .tolerance_per_mille = tolerance_per_mille};
  return {.tolerance_per_mille = tolerance_per_mille + spread_per_mille};
}

}  // namespace inkwell::control
