#include "boards/virtual/plant/hand.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <doctest/doctest.h>
#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/plant/driven_plant.hpp"

using namespace inkwell;
using namespace inkwell::test;

TEST_CASE("the hand takes the stylus out, moves it with minimum jerk, holds it still, and docks it again") {
  for (const auto& arm : test::all_arms()) {
    CAPTURE(arm.name);
    DrivenPlant driven(arm);
    driven.idle(0.05);
    const Vector3 goal = driven.plant.arm().dynamics().position_m(free_joints(arm));
    const Vector3 start = driven.plant.truth(driven.now).position_m;
    driven.plant.hold(start, 1500.0, 15.0);
    driven.plant.dock(false);
    driven.plant.follow({{0.0, start}, {0.5, goal}});
    double fastest_m_s = 0.0;
    for (int i = 0; i < 600; ++i) {
      driven.idle(0.001);
      fastest_m_s = std::max(fastest_m_s, driven.plant.truth(driven.now).velocity_m_s.norm());
    }
    // At the midpoint of a minimum-jerk movement, the speed is 15/8 of the mean speed.
    CHECK(fastest_m_s == doctest::Approx(1.875 * (goal - start).norm() / 0.5).scale(0).epsilon(0.1));
    Truth t = driven.plant.truth(driven.now);
    CHECK((t.position_m - goal).norm() < 0.002);
    CHECK_FALSE(t.docked);
    CHECK(driven.inputs.at(board::omni_driver.inkwell_switch) == PinLevel::floating);
    // With a steady hand the arm and the encoders are stationary.
    driven.idle(0.5);
    const auto counts = driven.inputs.counts;
    driven.idle(0.5);
    CHECK(driven.inputs.counts == counts);

    driven.plant.dock(true);
    driven.plant.let_go();
    fastest_m_s = 0.0;
    for (int i = 0; i < 2000; ++i) {
      driven.idle(0.001);
      fastest_m_s = std::max(fastest_m_s, driven.plant.truth(driven.now).velocity_m_s.norm());
    }
    // The hand returns straight to the inkwell at 0.2 m/s with a minimum-jerk movement.
    CHECK(fastest_m_s == doctest::Approx(1.875 * 0.2).scale(0).epsilon(0.1));
    t = driven.plant.truth(driven.now);
    CHECK(t.docked);
    CHECK(t.inkwell_switch);
    CHECK_FALSE(t.hand_holds);
    CHECK((t.position_m - driven.plant.inkwell().position_m()).norm() < 30e-6);
  }
}

TEST_CASE("a firm pull takes the stylus out of the inkwell, a slight one does not") {
  DrivenPlant driven(test::omni());
  const Vector3 home = driven.plant.truth(0).position_m;
  driven.plant.hold(home + Vector3(0.0, 0.01, 0.0), 300.0, 3.0);
  driven.idle(0.2);
  CHECK(driven.plant.truth(driven.now).docked);
  driven.plant.hold(home + Vector3(0.0, 0.04, 0.0), 300.0, 3.0);
  driven.idle(0.3);
  CHECK_FALSE(driven.plant.truth(driven.now).docked);
  CHECK((driven.plant.truth(driven.now).position_m - home).norm() > 0.03);
}

TEST_CASE("a released arm falls onto its stops and comes to rest") {
  DrivenPlant driven(test::omni());
  driven.plant.dock(false);
  driven.idle(2.0);
  const Truth t = driven.plant.truth(driven.now);
  CHECK(t.velocity_m_s.norm() < 1e-9);
  CHECK(t.position_m.y() < driven.plant.inkwell().position_m().y());
}

TEST_CASE("a wall made by the motors is stable against a stiff hand and keeps still") {
  // A proportional-derivative controller runs at 20 kHz in workspace coordinates. The controller's force is converted
  // to duty cycles without a current loop. The simulation includes the complete plant from duty cycles to position.
  const auto arm = test::omni();
  DrivenPlant driven(arm);
  driven.enable(true);
  const Vector3 centre = driven.plant.arm().dynamics().position_m(free_joints(arm));
  driven.plant.place(free_joints(arm), Vector3::Zero());
  driven.plant.hold(centre + Vector3(0.0, -0.003, 0.0), 5000.0, 5.0);
  Vector3 lowest = Vector3::Constant(1.0), highest = Vector3::Constant(-1.0);
  for (int period = 0; period < 20'000; ++period) {
    const Truth t = driven.plant.truth(driven.now);
    const auto terms = driven.plant.arm().dynamics().terms(t.joints_rad, t.joint_speeds_rad_s);
    Vector3 force_N = Vector3::Zero();
    if (t.position_m.y() < centre.y())
      force_N.y() = 1000.0 * (centre.y() - t.position_m.y()) - 2.0 * t.velocity_m_s.y();
    const Vector3 torque_Nm = terms.jacobian_m.transpose() * force_N;
    std::array<double, 3> duty;
    for (int i = 0; i < 3; ++i) {
      const auto motor = static_cast<unsigned>(i);
      const double current_A = torque_Nm[i] / test::torque_Nm_per_A(arm, motor);
      const double back_emf_V = test::torque_Nm_per_A(arm, motor) * t.joint_speeds_rad_s[i];
      duty[motor] = std::clamp((test::circuit_ohm(arm) * current_A + back_emf_V) / t.supply_V, -0.95, 0.95);
    }
    driven.run(50e-6, duty);
    if (period < 10'000) continue;
    lowest = lowest.cwiseMin(t.joints_rad);
    highest = highest.cwiseMax(t.joints_rad);
  }
  const Truth t = driven.plant.truth(driven.now);
  CHECK(t.position_m.y() < centre.y() - 0.001);  // the hand is inside the wall
  CHECK(std::abs(t.current_A[1]) > 0.3);
  for (int i = 0; i < 3; ++i) CHECK(highest[i] - lowest[i] < 2.0 * 0.4e-3);  // two encoder counts
}
