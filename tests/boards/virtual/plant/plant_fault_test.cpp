// Faults of encoders, shunts, motors, bridges and supply, by index.
#include "boards/virtual/plant/plant.hpp"

#include <array>
#include <cmath>

#include <doctest/doctest.h>
#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/plant/driven_plant.hpp"

using namespace inkwell;
using namespace inkwell::test;

namespace {

/// An arm without friction and weight, rotating about the waist axis.
struct Swinging {
  Swinging() : arm(weightless()), driven(arm) {
    driven.plant.place({-0.9, 0.8, 0.4}, {20.0, 0.0, 0.0});
    driven.plant.advance(0);
    before = driven.inputs.counts[0];
    true_before = driven.plant.truth(0).encoder_counts[0];
  }
  static arms::Description weightless() {
    auto arm = test::frictionless(test::omni());
    arm.simulation.gravity_m_per_s2 = 0.0;
    return arm;
  }
  std::int64_t counted() const { return driven.inputs.counts[0] - before; }
  std::int64_t turned() { return driven.plant.truth(driven.now).encoder_counts[0] - true_before; }
  arms::Description arm;
  DrivenPlant driven;
  std::int64_t before, true_before;
};

/// Runs the bridges at these duty cycles until the currents are constant. The run is too short for the joints to move.
DrivenPlant driven_at(std::array<double, 3> duty, double time_s = 0.003) {
  DrivenPlant driven(test::omni());
  driven.enable(true);
  driven.run(time_s, duty);
  return driven;
}

double current_A(DrivenPlant& driven, unsigned motor) { return driven.plant.truth(driven.now).current_A[motor]; }

double mean_measured_A(DrivenPlant& driven, unsigned motor) {
  double sum_A = 0.0;
  for (int n = 0; n < 500; ++n) sum_A += driven.measured_A(motor) / 500.0;
  return sum_A;
}

}  // namespace

TEST_CASE("an encoder with a stuck disc shows no edges, and its counts remain lost") {
  Swinging swinging;
  swinging.driven.plant.encoder_fault(0).set_stuck(true);
  swinging.driven.idle(0.02);
  CHECK(swinging.counted() == 0);
  const auto lost = swinging.turned();
  CHECK(lost > 50);
  swinging.driven.plant.encoder_fault(0).set_stuck(false);
  swinging.driven.idle(0.02);
  CHECK(swinging.counted() == swinging.turned() - lost);
  CHECK(swinging.driven.inputs.jumps == 0);
}

TEST_CASE("an encoder loses the requested share of its counts") {
  Swinging swinging;
  swinging.driven.plant.encoder_fault(0).lose(0.2);
  swinging.driven.idle(0.07);
  const auto turned = static_cast<double>(swinging.turned());
  CHECK(turned > 300);
  CHECK(static_cast<double>(swinging.counted()) / turned == doctest::Approx(0.8).epsilon(0.1));
  CHECK(swinging.driven.inputs.jumps == 0);
}

TEST_CASE("a disc that slips brings its counts edge by edge, slowly enough for the chip's filters") {
  for (const int slip : {400, -300}) {
    DrivenPlant driven(test::omni());
    driven.idle(0.001);
    const auto before = driven.inputs.counts[1];
    driven.inputs.newest_edge = {};
    driven.plant.encoder_fault(1).slip(slip);
    driven.idle(0.002);
    CHECK(driven.inputs.counts[1] - before == slip);
    CHECK(driven.inputs.jumps == 0);
    CHECK(seconds(driven.inputs.shortest_pause) > 1.5 * static_cast<double>(board::encoder_filter_s));
  }
}

TEST_CASE("a shunt amplifier with an offset, another gain, at a rail or frozen") {
  auto driven = driven_at({0.2, 0.0, 0.0});
  const double before_A = mean_measured_A(driven, 0);
  CHECK(before_A > 0.5);
  driven.plant.set_shunt_fault(0, {.offset_A = -0.7});
  CHECK(mean_measured_A(driven, 0) == doctest::Approx(before_A - 0.7).scale(0).epsilon(0.01));
  driven.plant.set_shunt_fault(0, {.gain = 0.25});
  CHECK(mean_measured_A(driven, 0) == doctest::Approx(0.25 * before_A).scale(0).epsilon(0.03));
  driven.plant.set_shunt_fault(0, {.output = ShuntFault::Output::upper_rail});
  CHECK(driven.read_V(board::omni_driver.motor_current[0]) == doctest::Approx(3.1));
  driven.plant.set_shunt_fault(0, {.output = ShuntFault::Output::lower_rail});
  CHECK(driven.read_V(board::omni_driver.motor_current[0]) == doctest::Approx(0.2));
  driven.plant.set_shunt_fault(0, {});
  driven.plant.set_shunt_fault(0, {.output = ShuntFault::Output::frozen});
  const double frozen_A = driven.measured_A(0);
  CHECK(std::abs(frozen_A - before_A) < 0.02);
  driven.run(0.003, {-0.2, 0.0, 0.0});
  CHECK(current_A(driven, 0) < -0.5);
  CHECK(driven.measured_A(0) == frozen_A);
}

TEST_CASE("an open motor immediately has no current and no torque, and both return after the fault is healed") {
  auto driven = driven_at({0.3, 0.3, 0.3});
  CHECK(current_A(driven, 1) > 1.0);
  driven.plant.set_motor_fault(1, {.open = true});
  CHECK(current_A(driven, 1) == 0.0);
  driven.run(0.002, {0.3, 0.3, 0.3});
  const Truth t = driven.plant.truth(driven.now);
  CHECK(t.current_A[1] == 0.0);
  CHECK(t.torque_Nm[1] == 0.0);
  CHECK(t.current_A[0] > 1.0);
  driven.plant.set_motor_fault(1, {});
  driven.run(0.003, {0.3, 0.3, 0.3});
  CHECK(current_A(driven, 1) > 1.0);
}

TEST_CASE("shorted turns and heat change current and torque as copper and magnets do") {
  const auto arm = test::omni();
  const double shunt_and_legs_ohm = test::circuit_ohm(arm) - test::winding_ohm(arm);
  const auto steady = [&](const MotorFault& fault) {
    DrivenPlant driven(arm);
    driven.plant.set_motor_fault(2, fault);
    driven.enable(true);
    // Full supply voltage is applied in one direction, too briefly for significant motion.
    driven.plant.output_changed(board::omni_driver.bridges[2].leg_a.pin.port,
                                board::omni_driver.bridges[2].leg_a.pin.number, PinLevel::high, 0);
    driven.idle(0.0012);
    return driven.plant.truth(driven.now);
  };
  const Truth healthy = steady({}), shorted = steady({.turns_left = 0.5}), hot = steady({.warmer_K = 100.0});
  const auto ohm = [](const Truth& t, double factor) {
    // Part of the voltage is back-EMF, which is proportional to speed and torque constant.
    const double constant = std::abs(t.torque_Nm[2] / t.current_A[2]);
    CHECK(factor > 0.0);
    return (t.supply_V - constant * std::abs(t.joint_speeds_rad_s[2])) / std::abs(t.current_A[2]);
  };
  CHECK(ohm(healthy, 1.0) == doctest::Approx(test::circuit_ohm(arm)).epsilon(0.03));
  CHECK(ohm(shorted, 0.5) == doctest::Approx(0.5 * test::winding_ohm(arm) + shunt_and_legs_ohm).epsilon(0.05));
  CHECK(ohm(hot, 0.8) == doctest::Approx(1.393 * test::winding_ohm(arm) + shunt_and_legs_ohm).epsilon(0.03));
  const double constant = test::torque_Nm_per_A(arm, 2);
  CHECK(std::abs(shorted.torque_Nm[2] / shorted.current_A[2]) == doctest::Approx(0.5 * constant));
  CHECK(std::abs(hot.torque_Nm[2] / hot.current_A[2]) == doctest::Approx(0.8 * constant));
}

TEST_CASE(
    "a half bridge with a shorted upper switch drives the motor until the bridge trips, each time it is enabled") {
  auto driven = driven_at({-0.3, 0.0, 0.0});
  CHECK(current_A(driven, 0) < -1.0);
  driven.plant.set_leg_fault(0, 0, LegFault::high);
  driven.run(0.0003, {-0.3, 0.0, 0.0});  // the lower switch is requested immediately
  Truth t = driven.plant.truth(driven.now);
  CHECK(t.bridge_fault);
  CHECK(driven.inputs.at(board::omni_driver.bridge_fault_tim1.pin) == PinLevel::low);
  driven.idle(0.001);
  CHECK(current_A(driven, 0) == 0.0);

  driven.enable(false);
  driven.idle(0.0001);
  CHECK(driven.inputs.at(board::omni_driver.bridge_fault_tim1.pin) == PinLevel::high);
  driven.enable(true);  // the inputs are low at rest: current flows through both switches of the leg
  driven.idle(0.0001);
  CHECK(driven.inputs.at(board::omni_driver.bridge_fault_tim1.pin) == PinLevel::low);

  driven.plant.set_leg_fault(0, 0, LegFault::none);
  driven.enable(false);
  driven.enable(true);
  driven.run(0.003, {-0.3, 0.0, 0.0});
  CHECK(current_A(driven, 0) < -1.0);
  CHECK_FALSE(driven.plant.truth(driven.now).bridge_fault);
}

TEST_CASE(
    "a shorted leg conducts while the bridge is disabled, so that a turning motor brakes through it and a diode") {
  auto arm = test::frictionless(test::omni());
  arm.simulation.gravity_m_per_s2 = 0.0;
  for (const double speed_rad_s : {20.0, -20.0}) {
    DrivenPlant driven(arm);
    driven.plant.set_leg_fault(0, 0, LegFault::low);
    driven.plant.place({0.0, 0.8, 0.4}, {speed_rad_s, 0.0, 0.0});
    driven.idle(0.001);
    const double back_emf_V = test::torque_Nm_per_A(arm, 0) * 20.0;
    CHECK(back_emf_V > 2.0);
    // A diode in the circuit permits current in one direction only.
    if (speed_rad_s > 0.0)
      CHECK(std::abs(current_A(driven, 0)) > 0.7 * (back_emf_V - 0.8) / test::circuit_ohm(arm));
    else
      CHECK(std::abs(current_A(driven, 0)) == 0.0);
  }
}

TEST_CASE("a leg that never conducts leaves one direction of current only, a slow one costs voltage") {
  auto driven = driven_at({0.0, 0.0, 0.0});
  driven.plant.set_leg_fault(1, 0, LegFault::open);
  driven.run(0.003, {0.0, 0.4, 0.0});
  CHECK(std::abs(current_A(driven, 1)) < 0.2);
  driven.plant.set_leg_fault(1, 0, LegFault::none);
  driven.run(0.003, {0.0, 0.4, 0.0});
  const double healthy_A = current_A(driven, 1);
  CHECK(healthy_A > 1.5);

  auto slow = driven_at({0.0, 0.0, 0.0});
  slow.plant.set_leg_delay(1, 0, 1e-6);
  slow.plant.set_leg_delay(1, 1, 1e-6);
  slow.run(0.003, {0.0, 0.4, 0.0});
  // The diodes conduct once per period in each leg, for the duration of the delay.
  const double lost_V = 2.0 * 1e-6 * board::pwm_Hz * static_cast<double>(board::supply_nominal_V);
  CHECK(healthy_A - current_A(slow, 1) ==
        doctest::Approx(lost_V / test::circuit_ohm(test::omni())).scale(0).epsilon(0.4));
}

TEST_CASE("a supply fault sets the voltage, and the supply returns to its setting after the fault") {
  DrivenPlant driven(test::omni());
  driven.plant.set_supply_V(20.0);
  driven.plant.fail_supply_at_V(30.0);
  driven.idle(0.01);
  CHECK(driven.plant.truth(driven.now).supply_V == doctest::Approx(30.0).epsilon(0.01));
  driven.plant.fail_supply_at_V(0.0);
  driven.idle(0.7);  // 300 ohm and 2200 uF
  CHECK(driven.plant.truth(driven.now).supply_V == doctest::Approx(30.0 * std::exp(-0.7 / 0.66)).epsilon(0.02));
  driven.plant.fail_supply_at_V(std::nullopt);
  driven.idle(0.01);
  CHECK(driven.plant.truth(driven.now).supply_V == doctest::Approx(20.0).epsilon(0.01));
}
