#include "boards/virtual/plant/plant.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <doctest/doctest.h>
#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/plant/driven_plant.hpp"

using namespace inkwell;
using namespace inkwell::test;

TEST_CASE("the arm starts docked, at rest and with its switch closed") {
  for (const auto& arm : test::all_arms()) {
    CAPTURE(arm.name);
    DrivenPlant driven(arm);
    driven.idle(0.5);
    const Truth t = driven.plant.truth(driven.now);
    CHECK(t.docked);
    CHECK(t.inkwell_switch);
    CHECK(driven.inputs.at(board::omni_driver.inkwell_switch) == PinLevel::low);
    CHECK((t.position_m - driven.plant.inkwell().position_m()).norm() < 30e-6);
    CHECK(t.velocity_m_s.norm() < 1e-9);
    CHECK(t.supply_V == doctest::Approx(board::supply_nominal_V).epsilon(0.01));
    CHECK(driven.inputs.at(board::omni_driver.bridge_fault_tim1.pin) == PinLevel::high);
  }
}

TEST_CASE("a current turns its joint forward and the encoder up, by gear and torque constant") {
  using protocol::Parameter;
  for (const bool reversed : {false, true})
    for (unsigned i = 0; i < 3; ++i) {
      auto arm = test::omni();
      arm.simulation.gravity_m_per_s2 = 0.0;
      for (unsigned j = 0; j < 3; ++j) {
        arm.parameters[of_axis(Parameter::motor_1_reversed, j)] = reversed;
        arm.parameters[of_axis(Parameter::encoder_1_reversed, j)] = reversed;
      }
      DrivenPlant driven(arm);
      driven.plant.place(free_joints(arm), Vector3::Zero());
      driven.idle(0.001);
      const auto counts = driven.inputs.counts;
      const Vector3 before = driven.plant.truth(driven.now).joints_rad;
      driven.enable(true);
      std::array<double, 3> duty{};
      duty[i] = 0.3;
      driven.run(0.02, duty);
      const Truth t = driven.plant.truth(driven.now);
      CAPTURE(i);
      const double turned_rad = t.joints_rad[i] - before[i];
      CHECK((reversed ? -1 : 1) * turned_rad > 0.02);
      const double counts_per_rad =
          static_cast<double>(arm.parameters[of_axis(Parameter::gear_ratio_1, i)]) *
          static_cast<double>(arm.parameters[of_axis(Parameter::encoder_1_counts_per_turn, i)]) /
          (2.0 * std::numbers::pi);
      CHECK(std::abs((reversed ? -1 : 1) * turned_rad * counts_per_rad -
                     static_cast<double>(driven.inputs.counts[i] - counts[i])) <= 1.0);
      CHECK(driven.inputs.jumps == 0);
      CHECK(t.torque_Nm[i] == doctest::Approx((reversed ? -1 : 1) * test::torque_Nm_per_A(arm, i) * t.current_A[i]));
    }
}

TEST_CASE("encoders count through fast motion without a lost edge") {
  auto arm = test::frictionless(test::omni());
  arm.simulation.gravity_m_per_s2 = 0.0;
  DrivenPlant driven(arm);
  driven.plant.place({-0.9, 0.8, 0.4}, {40.0, 0.0, 0.0});
  driven.plant.advance(0);
  const auto before = driven.inputs.counts;
  const auto encoder_before = driven.plant.truth(0).encoder_counts;
  driven.idle(0.2);
  const auto encoder_after = driven.plant.truth(driven.now).encoder_counts;
  CHECK(std::abs(encoder_after[0] - encoder_before[0]) > 500);
  for (unsigned i = 0; i < 3; ++i) CHECK(driven.inputs.counts[i] - before[i] == encoder_after[i] - encoder_before[i]);
  CHECK(driven.inputs.jumps == 0);
  // Two edges within one step of the arm have separate times, so that the chip's filters accept these edges.
  const double counts_per_s = 40.0 *
                              static_cast<double>(arm.parameters[protocol::Parameter::gear_ratio_1] *
                                                  arm.parameters[protocol::Parameter::encoder_1_counts_per_turn]) /
                              (2.0 * std::numbers::pi);
  CHECK(seconds(driven.inputs.shortest_pause) > 0.8 / counts_per_s);
  CHECK(driven.inputs.out_of_order == 0);
}

TEST_CASE("shunt amplifiers read the current within their imperfections") {
  const auto arm = test::omni();
  DrivenPlant driven(arm);
  driven.enable(true);
  driven.run(0.005, {0.2, -0.3, 0.0});
  const Truth t = driven.plant.truth(driven.now);
  CHECK(std::abs(t.current_A[0]) > 0.5);
  CHECK(std::abs(t.current_A[1]) > 0.5);
  const Imperfections imperfections;
  for (unsigned i = 0; i < 3; ++i) {
    double sum_A = 0.0, squares_A = 0.0;
    for (int n = 0; n < 1000; ++n) {
      const double read_A = driven.measured_A(i);
      sum_A += read_A;
      squares_A += read_A * read_A;
    }
    const double mean_A = sum_A / 1000.0;
    // Between the pulses the current decays with R / L, and the amplifier lags by its time constant.
    const double late_A = t.current_A[i] * (test::circuit_ohm(arm) / arm.motor.inductance_H) /
                          (2.0 * 3.14159265358979 * imperfections.amplifier_bandwidth_Hz);
    const double expected_A = (t.current_A[i] + late_A) * (1.0 + imperfections.amplifier_gain_error[i]) +
                              imperfections.amplifier_offset_V[i] / 0.4;
    CHECK(std::abs(mean_A - expected_A) < 0.001);
    const double noise_A = std::sqrt(squares_A / 1000.0 - mean_A * mean_A);
    CHECK(noise_A == doctest::Approx(imperfections.amplifier_noise_V / 0.4).scale(0).epsilon(0.15));
  }
}

TEST_CASE("the amplifier clips at its rails") {
  auto arm = test::omni();
  DrivenPlant driven(arm);
  driven.enable(true);
  driven.run(0.003, {0.95, -0.95, 0.0});
  CHECK(driven.plant.truth(driven.now).current_A[0] > 5.0);
  CHECK(driven.read_V(board::omni_driver.motor_current[0]) ==
        doctest::Approx(3.1));  // 0.2 V below the amplifier's supply
  CHECK(driven.read_V(board::omni_driver.motor_current[1]) == doctest::Approx(0.2));
}

TEST_CASE("the enable pin and a bridge fault switch the current off immediately, and floating pins brake the motor") {
  for (const int how : {0, 1, 2}) {
    CAPTURE(how);
    const auto arm = test::omni();
    DrivenPlant driven(arm);
    driven.enable(true);
    driven.run(0.003, {0.3, 0.3, -0.3});
    CHECK(std::abs(driven.plant.truth(driven.now).current_A[2]) > 1.0);
    if (how == 0) driven.enable(false);
    if (how == 1) driven.legs(PinLevel::floating);
    if (how == 2) driven.plant.set_bridge_fault(true);
    driven.idle(0.0005);
    const Truth t = driven.plant.truth(driven.now);
    if (how == 1) {  // low through their pull-downs: each motor is shorted and its back-EMF drives the remaining
                     // current
      const double back_emf_V = test::torque_Nm_per_A(arm, 2) * t.joint_speeds_rad_s[2];
      CHECK(std::abs(t.current_A[2] + back_emf_V / test::circuit_ohm(arm)) < 0.03);
    } else {
      CHECK(t.current_A.norm() == 0.0);
    }
    CHECK((driven.inputs.at(board::omni_driver.bridge_fault_tim1.pin) == PinLevel::low) == (how == 2));
    CHECK((driven.inputs.at(board::omni_driver.bridge_fault_tim8.pin) == PinLevel::low) == (how == 2));
    if (how == 2) {
      driven.plant.set_bridge_fault(false);
      driven.run(0.001, {0.3, 0.3, -0.3});
      CHECK(std::abs(driven.plant.truth(driven.now).current_A[2]) > 1.0);
    }
  }
}

TEST_CASE("bridges without their enable pin never switch") {
  DrivenPlant driven(test::omni());
  driven.run(0.002, {0.5, 0.5, 0.5});
  CHECK(driven.plant.truth(driven.now).current_A.norm() == 0.0);
}

TEST_CASE("the bridges switch off after the hold time if the heartbeat stops at any level") {
  const Ticks hold = ticks(static_cast<double>(board::omni_driver.bridge_hold_s));
  for (const PinLevel stopped_at : {PinLevel::high, PinLevel::low, PinLevel::floating}) {
    CAPTURE(static_cast<int>(stopped_at));
    DrivenPlant driven(test::omni());
    const auto is_on_at = [&](Ticks when) { return driven.plant.truth(when).bridges_enabled; };
    driven.enable(true);
    driven.run(0.003, {0.3, 0.3, -0.3});
    CHECK(driven.plant.truth(driven.now).current_A.norm() > 1.0);
    driven.legs(PinLevel::low);
    driven.beat();
    const Ticks newest = driven.now;
    driven.drive(board::omni_driver.bridge_heartbeat, stopped_at == PinLevel::high ? PinLevel::low : PinLevel::high);
    driven.now += 10;
    driven.drive(board::omni_driver.bridge_heartbeat, stopped_at);
    // The hold time restarts with the last rising edge of the heartbeat.
    const Ticks off = (stopped_at == PinLevel::high ? driven.now : newest) + hold;
    driven.now += 10;
    driven.drive(board::omni_driver.bridge_heartbeat, stopped_at);  // unchanged level, no rising edge
    CHECK(is_on_at(off - 1));
    CHECK_FALSE(is_on_at(off));
    driven.now = off;
    driven.is_halted = true;
    driven.idle(0.0005);
    CHECK(driven.plant.truth(driven.now).current_A.norm() == 0.0);
    // Enabling the bridges requires a heartbeat edge in addition to the enable input.
    driven.set_enable(false);
    driven.drive(board::omni_driver.bridge_heartbeat, PinLevel::low);
    driven.set_enable(true);
    CHECK_FALSE(is_on_at(driven.now));
    driven.is_halted = false;
    driven.beat();
    CHECK(is_on_at(driven.now));
    driven.set_enable(false);
    driven.set_enable(true);
    CHECK_FALSE(is_on_at(driven.now));
    // The bridges can be enabled during a high heartbeat, as in the control interrupt.
    driven.set_enable(false);
    CHECK_FALSE(is_on_at(driven.now));
    driven.drive(board::omni_driver.bridge_heartbeat, PinLevel::high);
    CHECK_FALSE(is_on_at(driven.now));
    driven.set_enable(true);
    CHECK(is_on_at(driven.now));
  }
}

TEST_CASE("the bridges switch off at the same time for every length of the simulation step") {
  const auto halted = [](Ticks slice) {
    DrivenPlant driven(test::omni());
    driven.plant.dock(false);
    driven.enable(true);
    driven.run(0.003, {0.3, 0.3, -0.3});
    driven.beat();
    const Ticks newest = driven.now;
    const auto& leg = driven.facts.bridges[1].leg_a.pin;
    driven.drive(leg, PinLevel::high);
    for (const Ticks end = driven.now + ticks(0.001); driven.now < end;) driven.plant.advance(driven.now += slice);
    const Truth t = driven.plant.truth(driven.now);
    CHECK(t.driven_until - newest == ticks(static_cast<double>(board::omni_driver.bridge_hold_s)));
    return t;
  };
  const Truth at_once = halted(ticks(0.001)), bit_by_bit = halted(ticks(0.000001));
  CHECK(at_once.current_A.norm() == 0.0);
  CHECK(at_once.joint_speeds_rad_s[1] != 0.0);
  CHECK((at_once.joint_speeds_rad_s - bit_by_bit.joint_speeds_rad_s).norm() < 1e-12);
  CHECK(at_once.supply_V == doctest::Approx(bit_by_bit.supply_V).epsilon(1e-9));
}

TEST_CASE("the supply sags under load, rises while the arm is braked, and is measured") {
  auto arm = test::frictionless(test::omni());
  arm.simulation.gravity_m_per_s2 = 0.0;
  DrivenPlant driven(arm);
  driven.enable(true);
  driven.plant.place({0.0, 0.8, 0.4}, Vector3::Zero());
  driven.run(0.01, {0.9, 0.0, 0.0});
  const Truth loaded = driven.plant.truth(driven.now);
  CHECK(loaded.supply_V < 17.5);
  CHECK(std::abs(driven.read_V(board::omni_driver.supply) * 11.0 - loaded.supply_V) < 0.05);

  driven.plant.place({-0.9, 0.8, 0.4}, {30.0, 0.0, 0.0});  // back-EMF 9.3 V at half the supply voltage
  double highest_V = 0.0;
  for (int i = 0; i < 40; ++i) {
    driven.run(0.0005, {0.2, 0.0, 0.0});
    highest_V = std::max(highest_V, driven.plant.truth(driven.now).supply_V);
  }
  CHECK(highest_V > 18.1);

  driven.enable(false);
  driven.plant.set_supply_V(0.0);
  driven.idle(0.6);
  CHECK(driven.plant.truth(driven.now).supply_V < 12.0);
}

TEST_CASE("the supply's reading follows through its divider's 0.9 ms") {
  DrivenPlant driven(test::omni());
  driven.idle(0.01);
  driven.plant.fail_supply_at_V(24.0);
  driven.idle(0.0025);  // the bus itself needs a third of a millisecond
  const double bus_V = driven.plant.truth(driven.now).supply_V;
  CHECK(bus_V == doctest::Approx(24.0).epsilon(0.005));
  // The supply rises with exp(-t / 0.33 ms) and is measured through a filter of 0.909 ms.
  CHECK(driven.read_V(board::omni_driver.supply) * 11.0 == doctest::Approx(24.0 - 6.0 * 0.10).epsilon(0.004));
}

TEST_CASE("an unstable supply oscillates around its voltage at 100 Hz, and comes to rest afterwards") {
  DrivenPlant driven(test::omni());
  driven.plant.swing_supply_by_V(3.0);
  int rises = 0;
  double lowest_V = 99.0, highest_V = 0.0, before_V = 18.0;
  for (int i = 0; i < 2'000; ++i) {
    driven.idle(0.00005);
    const double bus_V = driven.plant.truth(driven.now).supply_V;
    rises += before_V < 18.0 && bus_V >= 18.0;
    lowest_V = std::min(lowest_V, bus_V);
    highest_V = std::max(highest_V, bus_V);
    before_V = bus_V;
  }
  CHECK(std::abs(rises - 10) <= 1);
  CHECK(lowest_V == doctest::Approx(15.0).epsilon(0.01));
  CHECK(highest_V == doctest::Approx(21.0).epsilon(0.01));
  driven.plant.swing_supply_by_V(0.0);
  driven.idle(0.3);
  CHECK(driven.plant.truth(driven.now).supply_V == doctest::Approx(18.0).epsilon(0.01));
}

TEST_CASE("amplifiers and potentiometers go with VDDA, the supply's divider does not") {
  DrivenPlant driven(test::omni());
  driven.idle(0.001);
  driven.plant.set_analog_supply_V(3.0);
  for (const auto& current : board::omni_driver.motor_current)
    CHECK(driven.read_V(current) == doctest::Approx(1.5).epsilon(0.005));
  for (const auto& wiper : board::omni_driver.gimbal) CHECK(driven.read_V(wiper) == doctest::Approx(1.5).epsilon(0.01));
  CHECK(driven.read_V(board::omni_driver.supply) == doctest::Approx(18.0 / 11.0).epsilon(0.01));
  driven.plant.set_shunt_fault(0, {.output = ShuntFault::Output::upper_rail});
  CHECK(driven.read_V(board::omni_driver.motor_current[0]) == doctest::Approx(2.8));
  driven.plant.set_analog_supply_V(0.0);
  for (const auto& wiper : board::omni_driver.gimbal) CHECK(driven.read_V(wiper) == 0.0);
}

TEST_CASE("potentiometers invert the gimbal's characteristic, with wiper noise") {
  using protocol::Parameter;
  auto arm = test::omni();
  arm.parameters[Parameter::gimbal_2_square_rad] = 0.4f;
  DrivenPlant driven(arm);
  const Vector3 angles(0.7, 0.9, -1.1);
  driven.plant.turn_gimbal(angles);
  for (unsigned i = 0; i < 3; ++i) {
    double ratio = 0.0, lowest = 1.0, highest = 0.0;
    for (int n = 0; n < 400; ++n) {
      const double read = driven.read_V(board::omni_driver.gimbal[i]) / 3.3;
      ratio += read / 400.0;
      lowest = std::min(lowest, read);
      highest = std::max(highest, read);
    }
    const double square = arm.parameters[of_axis(Parameter::gimbal_1_square_rad, i)];
    const double slope = arm.parameters[of_axis(Parameter::gimbal_1_slope_rad, i)];
    const double offset = arm.parameters[of_axis(Parameter::gimbal_1_offset_rad, i)];
    CHECK(std::abs(square * ratio * ratio + slope * ratio + offset - angles[i]) < 0.002);
    CHECK(highest - lowest > 0.0005);
    CHECK(highest - lowest < 0.01);
  }
}

TEST_CASE("switches close to ground") {
  DrivenPlant driven(test::omni());
  CHECK(driven.inputs.at(board::omni_driver.button_1) == PinLevel::floating);
  driven.plant.press_buttons(true, false);
  driven.idle(0.0001);
  CHECK(driven.inputs.at(board::omni_driver.button_1) == PinLevel::low);
  CHECK(driven.inputs.at(board::omni_driver.button_2) == PinLevel::floating);
  driven.plant.press_buttons(false, true);
  driven.idle(0.0001);
  CHECK(driven.inputs.at(board::omni_driver.button_1) == PinLevel::floating);
  CHECK(driven.inputs.at(board::omni_driver.button_2) == PinLevel::low);
}

TEST_CASE("the same seed gives the same run, another seed other noise") {
  const auto run = [](std::uint64_t seed) {
    DrivenPlant driven(test::omni(), {.seed = seed});
    driven.enable(true);
    driven.plant.dock(false);
    driven.run(0.05, {0.1, 0.2, -0.1});
    return std::pair{driven.measured_A(1), driven.plant.truth(driven.now).joints_rad};
  };
  CHECK(run(3) == run(3));
  CHECK(run(3).first != run(4).first);
}
