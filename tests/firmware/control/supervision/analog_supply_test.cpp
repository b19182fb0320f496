// Tests the detection of a wrong VDDA with valid and invalid factory calibrations of VREFINT.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>

#include "firmware/control/supervision/analog_supply.hpp"

namespace {

using namespace inkwell;
using control::analog_supply;
using control::AnalogSupply;

constexpr float nominal_V = 3.3f;
constexpr int never = 1'000, noticed = 13;

std::uint16_t counts_of(float reference_V, float analog_supply_V) {
  return static_cast<std::uint16_t>(std::min(4096.0f * reference_V / analog_supply_V, 4095.0f));
}

/// Returns the number of checks after which this VDDA is detected; `true_V` is the chip's VREFINT.
int readings_until_fault(float analog_supply_V, float true_V, std::uint16_t calibrated_counts) {
  AnalogSupply supply = analog_supply(calibrated_counts);
  for (int reading = 1; reading < never; ++reading)
    if (supply.detect_supply_error(counts_of(true_V, analog_supply_V))) return reading;
  return never;
}

TEST_CASE(
    "with a measured reference, a VDDA error of 4.7 % raises no fault and an error of 5.3 % does, for every reference "
    "voltage") {
  for (const float reference_V : {1.18f, 1.21f, 1.24f})
    for (const float sign : {1.0f, -1.0f}) {
      CAPTURE(reference_V);
      CAPTURE(sign);
      const std::uint16_t calibrated_counts = counts_of(reference_V, nominal_V);
      CHECK(readings_until_fault(nominal_V * (1.0f + sign * 0.047f), reference_V, calibrated_counts) == never);
      CHECK(readings_until_fault(nominal_V * (1.0f + sign * 0.053f), reference_V, calibrated_counts) == noticed);
    }
}

TEST_CASE("with a missing or lost calibration the check has a larger tolerance, and no healthy part raises a fault") {
  for (const std::uint16_t calibrated_counts : {0, 1'100, 1'440, 1'560, 4'095, 0xFFFF}) {
    CAPTURE(calibrated_counts);
    for (const float reference_V : {1.18f, 1.21f, 1.24f}) {
      CAPTURE(reference_V);
      for (const float part : {0.96f, 1.0f, 1.04f})
        CHECK(readings_until_fault(part * nominal_V, reference_V, calibrated_counts) == never);
      CHECK(readings_until_fault(0.88f * nominal_V, reference_V, calibrated_counts) == noticed);
      CHECK(readings_until_fault(1.12f * nominal_V, reference_V, calibrated_counts) == noticed);
    }
  }
  // VREFINT is at a data sheet limit, and its calibration is wrong by 3 per mille.
  CHECK(readings_until_fault(0.94f * nominal_V, 1.18f, counts_of(1.177f, nominal_V)) == noticed);
  CHECK(readings_until_fault(1.06f * nominal_V, 1.24f, counts_of(1.243f, nominal_V)) == noticed);
}

TEST_CASE("a reference that reads nothing, or all there is, is off") {
  CHECK(readings_until_fault(1e9f, 1.21f, 1'501) == noticed);
  CHECK(readings_until_fault(0.1f, 1.21f, 1'501) == noticed);
}

TEST_CASE("the reading of the reference gives VDDA") {
  const AnalogSupply supply = analog_supply(counts_of(1.22f, nominal_V));
  for (const float analog_V : {3.0f, 3.3f, 3.5f})
    CHECK(supply.analog_supply_V(counts_of(1.22f, analog_V)) == doctest::Approx(analog_V).epsilon(0.001));
  CHECK(supply.analog_supply_V(0) == 0.0f);
}

TEST_CASE("twelve wrong readings in a row raise no fault, and one right reading resets the count") {
  const std::uint16_t right = counts_of(1.21f, nominal_V), wrong = counts_of(1.21f, 3.0f);
  AnalogSupply supply = analog_supply(right);
  for (int i = 0; i < 10; ++i) {
    for (int reading = 0; reading < 12; ++reading) CHECK_FALSE(supply.detect_supply_error(wrong));
    CHECK_FALSE(supply.detect_supply_error(right));
  }
  for (int reading = 0; reading < 12; ++reading) CHECK_FALSE(supply.detect_supply_error(wrong));
  for (int reading = 0; reading < 10; ++reading) CHECK(supply.detect_supply_error(wrong));
}

}  // namespace
