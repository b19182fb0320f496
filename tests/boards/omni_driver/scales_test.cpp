// Compares the board's scale factors with values that this test computes from the components and wiring in README.md.
// Firmware and simulation use the same board facts, so a comparison between firmware and simulation would not reveal a
// wrong fact.
#include "boards/omni_driver/facts.hpp"

#include <numbers>

#include <doctest/doctest.h>
#include "tests/boards/virtual/plant/driven_plant.hpp"

namespace {

using namespace inkwell;
using doctest::Approx;

TEST_CASE("clocks: 8 MHz crystal, 168 MHz processor, 48 MHz USB") {
  CHECK(board::omni_driver.crystal_Hz == 8'000'000);
  CHECK(board::processor_Hz == 168'000'000);
  CHECK(board::usb_Hz == 48'000'000);
  CHECK(board::timer_apb2_Hz == 168'000'000);
  CHECK(board::apb1_Hz == 42'000'000);
  CHECK(board::adc_Hz == 21'000'000);
  CHECK(board::injected_conversion_s == Approx(0.714286e-6).scale(0));
}

TEST_CASE("PWM: 60 kHz centre-aligned in 1400 steps, three periods to a control period of 50 us") {
  CHECK(board::pwm_Hz == 60'000);
  CHECK(board::pwm_top == 1400);
  CHECK(board::pwm_repetition == 5);
  CHECK(board::servo_cycles == 8400);
  CHECK(board::duty_limit == 0.92f);
  CHECK(board::omni_driver.bridge_dead_time_s == 0.2e-6f);
  CHECK(board::current_ripple_A(0.238e-3f) == Approx(0.157563));
}

TEST_CASE("heartbeat: 8.2 k and 10 nF hold the bridges for 82 us, 69 to 96 with tolerances of 10, 1 and 5 %") {
  CHECK(board::omni_driver.bridge_hold_s == Approx(8.2e3 * 10e-9).scale(0));
  CHECK(board::omni_driver.bridge_hold_shortest_s() < 82e-6 * 0.9 * 0.99 * 0.95);
  CHECK(board::omni_driver.bridge_hold_longest_s() == Approx(82e-6 * 1.1 * 1.01 * 1.05).scale(0).epsilon(0.001));
}

TEST_CASE("motor current: 20 mohm and a gain of 20 are 0.4 V/A around 1.65 V, 496.5 counts an ampere") {
  CHECK(1.0 / board::omni_driver.current_step_A() == Approx(496.485));
  CHECK(board::shunt_amplifier_offset_V == Approx(1.65));
  CHECK(board::omni_driver.current_range_A() == Approx(4.125));
  CHECK(board::omni_driver.shunt_ohm == 0.02f);
}

TEST_CASE("supply: 100 k over 10 k, 18 V are 2031 counts; 12 V to 24 V are allowed") {
  CHECK(18.0 / board::omni_driver.supply_step_V() == Approx(2031.07));
  CHECK(board::supply_minimum_V == 12.0f);
  CHECK(board::supply_nominal_V == 18.0f);
  CHECK(board::supply_maximum_V == 24.0f);
}

TEST_CASE("the pins have the expected voltages for the supply, the potentiometers and the motor currents") {
  test::DrivenPlant driven(test::omni());
  CHECK(driven.read_V(board::omni_driver.supply) == Approx(18.0 / 11.0).epsilon(0.01));
  for (const auto& wiper : board::omni_driver.gimbal)
    CHECK(driven.read_V(wiper) == Approx(1.65).epsilon(0.01));  // mid-scale
  driven.enable(true);
  driven.run(0.003, {0.2, -0.2, 0.0});
  const auto truth = driven.plant.truth(driven.now);
  REQUIRE(truth.current_A[0] > 0.8);
  REQUIRE(truth.current_A[1] < -0.8);
  for (const int motor : {0, 1})
    CHECK(driven.read_V(board::omni_driver.motor_current[motor]) ==
          Approx(1.65 + 0.4 * truth.current_A[motor]).epsilon(0.02));
}

TEST_CASE("encoder: 360 lines are 1440 counts in a turn of the motor, 13.3 turns in a turn of the waist") {
  test::DrivenPlant driven(test::omni());
  driven.plant.place({0.5, 0.25, 0.1}, {0.0, 0.0, 0.0});
  driven.idle(0.00005);
  CHECK(std::abs(static_cast<double>(driven.inputs.counts[0] - driven.counts_at_start[0]) - 0.5 * 3048.08) <= 1.0);
}

TEST_CASE("encoder filter: 0.38 us, and each arm's fastest edges hold an input ten times as long") {
  CHECK(board::encoder_filter_s == Approx(0.380952e-6).scale(0));
  using protocol::Parameter;
  for (const auto& arm : test::all_arms()) {
    const auto torque_constants = arm.parameters.of_each(Parameter::torque_constant_1_Nm_per_A);
    const auto counts_per_turn = arm.parameters.of_each(Parameter::encoder_1_counts_per_turn);
    for (unsigned motor = 0; motor < 3; ++motor) {
      CAPTURE(arm.name);
      CAPTURE(motor);
      // No motor exceeds its no-load speed at the highest supply voltage. Each encoder input changes its level every
      // two counts.
      const double fastest_rad_per_s = static_cast<double>(board::supply_maximum_V / torque_constants[motor]);
      const double counts_per_s =
          fastest_rad_per_s / (2.0 * std::numbers::pi) * static_cast<double>(counts_per_turn[motor]);
      CHECK(2.0 / counts_per_s > 10.0 * static_cast<double>(board::encoder_filter_s));
    }
  }
}

}  // namespace
