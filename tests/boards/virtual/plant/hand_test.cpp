#include <plant/hand.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <doctest/doctest.h>
#include <board/omni_driver.hpp>

#include "bench.hpp"

using namespace inkwell;
using namespace inkwell::test;

TEST_CASE("the hand takes the stylus out, moves it with minimum jerk, holds it still, and docks it again") {
  for (const auto& arm : {test::omni(), test::paper()}) {
    CAPTURE(arm.name);
    Bench bench(arm);
    bench.idle(0.05);
    const Vector3 goal = bench.plant.arm().dynamics().position_m(free_joints(arm));
    const Vector3 start = bench.plant.truth(bench.now).position_m;
    bench.plant.hold(start, 1500.0, 15.0);
    bench.plant.dock(false);
    bench.plant.follow({{0.0, start}, {0.5, goal}});
    double fastest_m_s = 0.0;
    for (int i = 0; i < 600; ++i) {
      bench.idle(0.001);
      fastest_m_s = std::max(fastest_m_s, bench.plant.truth(bench.now).velocity_m_s.norm());
    }
    // A minimum-jerk movement is fastest in its middle, at 15/8 of its mean speed.
    CHECK(fastest_m_s == doctest::Approx(1.875 * (goal - start).norm() / 0.5).epsilon(0.1));
    Truth t = bench.plant.truth(bench.now);
    CHECK((t.position_m - goal).norm() < 0.002);
    CHECK_FALSE(t.docked);
    CHECK(bench.pins.at(board::inkwell_switch) == PinLevel::floating);
    // A steady hand: the arm rests, and so do the encoders.
    bench.idle(0.5);
    const auto counts = bench.pins.counts;
    bench.idle(0.5);
    CHECK(bench.pins.counts == counts);

    bench.plant.dock(true);
    bench.plant.let_go();
    bench.idle(2.0);
    t = bench.plant.truth(bench.now);
    CHECK(t.docked);
    CHECK(t.inkwell_switch);
    CHECK_FALSE(t.hand_holds);
    CHECK((t.position_m - bench.plant.inkwell().position_m()).norm() < 30e-6);
  }
}

TEST_CASE("a firm pull takes the stylus out of the inkwell, a slight one does not") {
  Bench bench(test::omni());
  const Vector3 home = bench.plant.truth(0).position_m;
  bench.plant.hold(home + Vector3(0.0, 0.01, 0.0), 300.0, 3.0);
  bench.idle(0.2);
  CHECK(bench.plant.truth(bench.now).docked);
  bench.plant.hold(home + Vector3(0.0, 0.04, 0.0), 300.0, 3.0);
  bench.idle(0.3);
  CHECK_FALSE(bench.plant.truth(bench.now).docked);
  CHECK((bench.plant.truth(bench.now).position_m - home).norm() > 0.03);
}

TEST_CASE("an arm that is let go falls onto its stops and rests") {
  Bench bench(test::omni());
  bench.plant.dock(false);
  bench.idle(2.0);
  const Truth t = bench.plant.truth(bench.now);
  CHECK(t.velocity_m_s.norm() < 1e-9);
  CHECK(t.position_m.y() < bench.plant.inkwell().position_m().y());
}

TEST_CASE("a wall made by the motors is stable against a stiff hand and keeps still") {
  // Proportional-derivative force in the workspace at 20 kHz, turned into duty without a current loop: a crude
  // device, but with the true plant between duty and position.
  const auto arm = test::omni();
  Bench bench(arm);
  bench.enable(true);
  const Vector3 centre = bench.plant.arm().dynamics().position_m(free_joints(arm));
  bench.plant.place(free_joints(arm), Vector3::Zero());
  bench.plant.hold(centre + Vector3(0.0, -0.003, 0.0), 5000.0, 5.0);
  Vector3 lowest = Vector3::Constant(1.0), highest = Vector3::Constant(-1.0);
  for (int period = 0; period < 20'000; ++period) {
    const Truth t = bench.plant.truth(bench.now);
    const auto terms = bench.plant.arm().dynamics().terms(t.joints_rad, t.joint_speeds_rad_s);
    Vector3 force_N = Vector3::Zero();
    if (t.position_m.y() < centre.y())
      force_N.y() = 1000.0 * (centre.y() - t.position_m.y()) - 2.0 * t.velocity_m_s.y();
    const Vector3 torque_Nm = terms.jacobian_m.transpose() * force_N;
    std::array<double, 3> duty;
    for (int i = 0; i < 3; ++i) {
      const double current_A = torque_Nm[i] / ((i == 0 ? 13.3 : 11.2) * 0.0234);
      const double back_emf_V = (i == 0 ? 13.3 : 11.2) * 0.0234 * t.joint_speeds_rad_s[i];
      duty[static_cast<std::size_t>(i)] = std::clamp((2.26 * current_A + back_emf_V) / t.supply_V, -0.95, 0.95);
    }
    bench.run(50e-6, duty);
    if (period < 10'000) continue;
    lowest = lowest.cwiseMin(t.joints_rad);
    highest = highest.cwiseMax(t.joints_rad);
  }
  const Truth t = bench.plant.truth(bench.now);
  CHECK(t.position_m.y() < centre.y() - 0.001);  // the hand is in the wall
  CHECK(std::abs(t.current_A[1]) > 0.3);
  for (int i = 0; i < 3; ++i) CHECK(highest[i] - lowest[i] < 2.0 * 0.4e-3);  // two encoder counts
}
