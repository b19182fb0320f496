#include "boards/virtual/plant/arm_motion.hpp"

#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "tests/boards/virtual/plant/arms.hpp"

namespace {

using namespace inkwell;
using virtual_board::ArmMotion;
using virtual_board::Coupling;
using virtual_board::Vector3;

constexpr double step_s = 1.0 / 60'000;
const Vector3 no_torque = Vector3::Zero();

void run(ArmMotion& arm, double duration_s, const Vector3& torque_Nm, std::span<const Coupling> couplings = {}) {
  const auto steps = static_cast<int>(std::lround(duration_s / step_s));
  for (int i = 0; i < steps; ++i) arm.step(step_s, torque_Nm, couplings);
}

double energy_J(const ArmMotion& arm) {
  return arm.dynamics().kinetic_energy_J(arm.joints_rad(), arm.joint_speeds_rad_s()) +
         arm.dynamics().potential_energy_J(arm.joints_rad());
}

/// Moves the stops beyond the reach of the arm.
arms::Description unbounded(arms::Description arm) {
  using protocol::Parameter;
  for (auto p : {Parameter::joint_1_minimum_rad, Parameter::joint_2_minimum_rad, Parameter::elbow_minimum_rad})
    arm.parameters[p] = -1e6f;
  for (auto p : {Parameter::joint_1_maximum_rad, Parameter::joint_2_maximum_rad, Parameter::elbow_maximum_rad})
    arm.parameters[p] = 1e6f;
  return arm;
}

Vector3 position_m(const ArmMotion& arm) { return arm.dynamics().position_m(arm.joints_rad()); }

}  // namespace

TEST_CASE("without friction a falling, turning arm keeps its energy") {
  for (const auto& description : test::all_arms()) {
    CAPTURE(description.name);
    ArmMotion arm(unbounded(test::frictionless(description)), {0.0, 1.0, -0.5});
    arm.place({0.0, 1.0, -0.5}, {6.0, -3.0, 2.0});
    const double start_J = energy_J(arm);
    double worst_J = 0.0, kinetic_J = 0.0;
    for (int i = 0; i < 120'000; ++i) {
      arm.step(step_s, no_torque, {});
      worst_J = std::max(worst_J, std::abs(energy_J(arm) - start_J));
      kinetic_J = std::max(kinetic_J, arm.dynamics().kinetic_energy_J(arm.joints_rad(), arm.joint_speeds_rad_s()));
    }
    CHECK(kinetic_J > 0.01);
    CHECK(worst_J < 1e-5 * kinetic_J);
  }
}

TEST_CASE("friction removes the energy of its torque times its travel") {
  auto description = unbounded(test::omni());
  description.simulation.gravity_m_per_s2 = 0.0;
  description.simulation.viscous_friction_Nms_per_rad = {};
  ArmMotion arm(description, Vector3::Zero());
  arm.place({0.0, 0.5, 0.2}, {5.0, 0.0, 0.0});
  const double start_J = energy_J(arm);
  run(arm, 0.02, no_torque);
  double way_Nm_rad = 0.0;
  for (int i = 0; i < 3; ++i) way_Nm_rad += 0.010 * std::abs(arm.joints_rad()[i] - (i == 1 ? 0.5 : i == 2 ? 0.2 : 0.0));
  CHECK(arm.joint_speeds_rad_s()[0] > 1.0);
  CHECK(start_J - energy_J(arm) == doctest::Approx(way_Nm_rad).scale(0).epsilon(1e-3));
}

TEST_CASE("Coulomb friction holds the arm at rest below its limit, and a larger torque moves the arm") {
  auto description = test::omni();
  description.simulation.gravity_m_per_s2 = 0.0;
  ArmMotion arm(description, {0.1, 0.8, 0.3});
  run(arm, 0.5, {0.0099, -0.0099, 0.0099});
  CHECK((arm.joints_rad() - Vector3(0.1, 0.8, 0.3)).norm() < 1e-12);
  CHECK(arm.joint_speeds_rad_s().norm() < 1e-12);

  run(arm, 0.1, {0.012, 0.0, 0.0});
  CHECK(arm.joints_rad()[0] > 0.105);
  // Without torque the arm comes to rest and remains at rest.
  run(arm, 1.0, no_torque);
  const Vector3 rest = arm.joints_rad();
  run(arm, 1.0, no_torque);
  CHECK((arm.joints_rad() - rest).norm() < 1e-12);
}

TEST_CASE("a steady hand brings the arm to rest, at any stiffness it may have") {
  for (const double stiffness : {100.0, 800.0, 5000.0}) {
    CAPTURE(stiffness);
    ArmMotion arm(test::omni(), {0.0, 0.6, 0.3});
    const Vector3 target = position_m(arm) + Vector3(0.004, -0.003, 0.002);
    const std::array hand{Coupling{stiffness, 3.0, target, Vector3::Zero()}};
    run(arm, 2.0, no_torque, hand);
    CHECK(arm.joint_speeds_rad_s().norm() < 1e-9);
    const Vector3 rest = arm.joints_rad();
    run(arm, 1.0, no_torque, hand);
    CHECK((arm.joints_rad() - rest).norm() < 1e-9);
    // At rest, the spring force is at most the sum of friction and gravity, about 1.3 N.
    CHECK((position_m(arm) - target).norm() < 1.3 / stiffness + 1e-4);
  }
}

TEST_CASE("a stiff, undamped hand does not blow up") {
  ArmMotion arm(unbounded(test::frictionless(test::omni())), {0.0, 0.6, 0.3});
  const Vector3 target = position_m(arm) + Vector3(0.0, 0.002, 0.0);
  const std::array hand{Coupling{5000.0, 0.0, target, Vector3::Zero()}};
  const double spring_J = 0.5 * 5000.0 * 0.002 * 0.002;
  for (int i = 0; i < 120'000; ++i) {
    arm.step(step_s, no_torque, hand);
    REQUIRE(arm.dynamics().kinetic_energy_J(arm.joints_rad(), arm.joint_speeds_rad_s()) < 2.0 * spring_J);
  }
}

TEST_CASE("the stops limit each joint of a falling arm, and the elbow stop limits the angle between the links") {
  for (const auto& description : test::all_arms()) {
    CAPTURE(description.name);
    using protocol::Parameter;
    const auto& p = description.parameters;
    const Vector3 inkwell(p[Parameter::inkwell_joint_1_rad], p[Parameter::inkwell_joint_2_rad],
                          p[Parameter::inkwell_joint_3_rad]);
    ArmMotion arm(description, inkwell);
    run(arm, 3.0, {0.2, 0.0, 0.0});
    CHECK(arm.joint_speeds_rad_s().norm() < 1e-9);
    const double torque_Nm = 0.2;
    // Friction balances part of the torque, and the stop of joint 1 balances the rest.
    const double beyond_rad = arm.joints_rad()[0] - p[Parameter::joint_1_maximum_rad];
    CHECK(beyond_rad > (torque_Nm - 0.011) / 20.0);
    CHECK(beyond_rad < (torque_Nm + 0.011) / 20.0);
    CHECK(arm.joints_rad()[1] > p[Parameter::joint_2_minimum_rad] - 0.02);
    CHECK(arm.dynamics().elbow_rad(arm.joints_rad()) > p[Parameter::elbow_minimum_rad] - 0.02);
    CHECK(arm.dynamics().elbow_rad(arm.joints_rad()) < p[Parameter::elbow_maximum_rad] + 0.02);
  }
}
