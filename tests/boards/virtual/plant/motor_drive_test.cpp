#include "boards/virtual/plant/motor_drive.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>
#include <arm/defaults.hpp>
#include "boards/omni_driver/facts.hpp"

namespace {

using namespace inkwell;
using virtual_board::Imperfections;
using virtual_board::Leg;
using virtual_board::MotorDrive;
using virtual_board::Ticks;
using virtual_board::ticks;

constexpr double resistance_ohm = 2.20, bus_V = board::supply_nominal_V;
constexpr double inductance_H = arm_defaults::motor::inductance_H;

Imperfections ideal() {
  Imperfections i;
  i.leg_resistance_ohm = 0.0;
  return i;
}

MotorDrive drive(double dead_time_s = 0.0, const Imperfections& imperfections = ideal()) {
  MotorDrive motor({resistance_ohm, inductance_H}, imperfections, dead_time_s);
  motor.set_bus_V(bus_V);
  return motor;
}

/// Runs center-aligned, unipolar switching and returns the extremes and the mean of the current in the last period.
struct Ripple {
  double lowest_A = 1e9, highest_A = -1e9, mean_A = 0.0, at_turning_point_A = 0.0;
};
Ripple switch_bridge(MotorDrive& motor, double duty, int periods, Ticks& now) {
  const Ticks period = virtual_board::ticks_per_s / board::pwm_Hz;
  Ripple ripple;
  const double duty_a = (1.0 + duty) / 2.0, duty_b = (1.0 - duty) / 2.0;
  for (int i = 0; i < periods; ++i) {
    const bool last = i == periods - 1;
    const auto edge = [&](double part, unsigned leg, Leg level) {
      motor.set_leg(leg, level, now + static_cast<Ticks>(part * static_cast<double>(period)));
      if (!last) return;
      ripple.lowest_A = std::min(ripple.lowest_A, motor.current_A());
      ripple.highest_A = std::max(ripple.highest_A, motor.current_A());
    };
    if (last) motor.take_charges();
    // The period starts in the middle of a zero vector with both legs low. The leg with the larger duty cycle switches
    // high first and low last.
    const unsigned first = duty >= 0.0 ? 0 : 1;
    const double longer = std::max(duty_a, duty_b), shorter = std::min(duty_a, duty_b);
    edge((1.0 - longer) / 2.0, first, Leg::high);
    edge((1.0 - shorter) / 2.0, 1 - first, Leg::high);
    motor.advance(now + period / 2);
    if (last) ripple.at_turning_point_A = motor.current_A();
    edge((1.0 + shorter) / 2.0, 1 - first, Leg::low);
    edge((1.0 + longer) / 2.0, first, Leg::low);
    now += period;
    motor.advance(now);
  }
  ripple.mean_A = motor.take_charges().motor_As / virtual_board::seconds(period);
  return ripple;
}

}  // namespace

TEST_CASE("a voltage step drives the current along R and L") {
  auto motor = drive();
  motor.set_leg(1, Leg::low, 0);
  motor.set_leg(0, Leg::high, 0);
  const double time_constant_s = inductance_H / resistance_ohm;
  for (const double at_s : {20e-6, 50e-6, 108e-6, 300e-6, 2e-3}) {
    motor.advance(ticks(at_s));
    CHECK(motor.current_A() ==
          doctest::Approx(bus_V / resistance_ohm * (1.0 - std::exp(-at_s / time_constant_s))).epsilon(1e-6));
  }
  // The charge is the integral of the current after a voltage step.
  const auto charges = motor.take_charges();
  CHECK(charges.motor_As == doctest::Approx(bus_V / resistance_ohm * (2e-3 - time_constant_s)).scale(0).epsilon(1e-6));
  CHECK(charges.supply_As == doctest::Approx(charges.motor_As));
}

TEST_CASE("the back-EMF counts against the voltage") {
  auto motor = drive();
  motor.set_back_emf_V(3.0);
  motor.set_leg(0, Leg::low, 0);
  motor.set_leg(1, Leg::low, 0);
  motor.advance(ticks(5e-3));
  CHECK(motor.current_A() == doctest::Approx(-3.0 / resistance_ohm));  // a shorted motor brakes
  CHECK(motor.take_charges().supply_As == 0.0);
}

TEST_CASE("the ripple is that of unipolar switching, and its mean stands at the turning point") {
  auto motor = drive();
  Ticks now = 0;
  const auto ripple = switch_bridge(motor, 0.5, 1000, now);
  CHECK(ripple.mean_A == doctest::Approx(0.5 * bus_V / resistance_ohm).scale(0).epsilon(1e-3));
  CHECK(ripple.highest_A - ripple.lowest_A ==
        doctest::Approx(static_cast<double>(board::current_ripple_A(arm_defaults::motor::inductance_H)))
            .scale(0)
            .epsilon(0.01));
  CHECK(ripple.at_turning_point_A == doctest::Approx(ripple.mean_A).scale(0).epsilon(1e-3));
  const auto none = switch_bridge(motor, 0.0, 1000, now);
  CHECK(none.highest_A - none.lowest_A < 1e-6);
}

TEST_CASE("the supply provides the power that the motor draws") {
  auto motor = drive();
  Ticks now = 0;
  const double mean_A = switch_bridge(motor, 0.5, 1000, now).mean_A;
  // Switches each edge of one period separately and reads the charges of the period. At duty cycle 0.5 the supply
  // drives the motor half of the time.
  const Ticks period = virtual_board::ticks_per_s / board::pwm_Hz;
  motor.set_leg(0, Leg::high, now + period / 8);
  motor.set_leg(1, Leg::high, now + 3 * period / 8);
  motor.set_leg(1, Leg::low, now + 5 * period / 8);
  motor.set_leg(0, Leg::low, now + 7 * period / 8);
  motor.advance(now + period);
  const auto charges = motor.take_charges();
  const double period_s = virtual_board::seconds(period);
  CHECK(charges.supply_As * bus_V ==
        doctest::Approx(resistance_ohm * mean_A * mean_A * period_s).scale(0).epsilon(2e-3));
}

TEST_CASE("a floating bridge kills the current through its diodes and leaves it at zero") {
  for (const double sign : {1.0, -1.0}) {
    auto motor = drive();
    motor.set_leg(0, sign > 0 ? Leg::high : Leg::low, 0);
    motor.set_leg(1, sign > 0 ? Leg::low : Leg::high, 0);
    motor.advance(ticks(100e-6));
    const double start_A = motor.current_A();
    CHECK(sign * start_A > 1.0);
    motor.take_charges();
    motor.set_leg(0, Leg::floating, ticks(100e-6));
    motor.set_leg(1, Leg::floating, ticks(100e-6));
    // The current decays against the supply and two diodes: L i' = -(V + 2 Vd) - R i.
    const double final_A = (bus_V + 1.6) / resistance_ohm;
    const double to_zero_s = inductance_H / resistance_ohm * std::log((std::abs(start_A) + final_A) / final_A);
    motor.advance(ticks(100e-6 + 0.9 * to_zero_s));
    CHECK(sign * motor.current_A() > 0.0);
    motor.advance(ticks(100e-6 + 1.1 * to_zero_s));
    CHECK(motor.current_A() == 0.0);
    CHECK(motor.take_charges().supply_As < 0.0);  // the energy of the inductance returns to the supply
    motor.set_back_emf_V(sign * 15.0);            // too low to open the diodes
    motor.advance(ticks(10e-3));
    CHECK(motor.current_A() == 0.0);
    motor.set_back_emf_V(sign * 25.0);  // a motor with a back-EMF above the supply voltage feeds the supply
    motor.advance(ticks(20e-3));
    CHECK(motor.current_A() == doctest::Approx(-sign * (25.0 - 19.6) / resistance_ohm));
  }
}

TEST_CASE("the dead time costs a voltage against the current's direction") {
  auto motor = drive(static_cast<double>(board::omni_driver.bridge_dead_time_s));
  Ticks now = 0;
  const auto ripple = switch_bridge(motor, 0.3, 2000, now);
  // The dead time shortens the pulse of leg A and lengthens the pulse of leg B. During the dead times the current also
  // flows against the diodes' forward voltages.
  const double lost_V =
      2.0 * static_cast<double>(board::omni_driver.bridge_dead_time_s) * board::pwm_Hz * (bus_V + 2.0 * 0.8);
  CHECK(lost_V > 0.4);
  CHECK(ripple.mean_A == doctest::Approx((0.3 * bus_V - lost_V) / resistance_ohm).scale(0).epsilon(0.005));
}

TEST_CASE("the shunt amplifier follows as a first-order low pass") {
  auto motor = drive();
  motor.set_leg(1, Leg::low, 0);
  motor.set_leg(0, Leg::high, 0);
  const double amplifier_s = 1.0 / (2.0 * 3.14159265358979 * 400e3);
  double followed_A = 0.0;
  constexpr double step_s = 2e-9;
  for (int i = 1; i <= 10'000; ++i) {
    const double before_A = motor.current_A();
    motor.advance(ticks(i * step_s));
    followed_A += (0.5 * (before_A + motor.current_A()) - followed_A) * (1.0 - std::exp(-step_s / amplifier_s));
  }
  CHECK(motor.current_A() > 1.0);
  CHECK(motor.amplifier_A() == doctest::Approx(followed_A).epsilon(1e-4));
  CHECK(motor.amplifier_A() < motor.current_A());
}
