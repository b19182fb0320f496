#include "boards/virtual/plant/arm_dynamics.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "tests/boards/virtual/plant/arms.hpp"

namespace {

using namespace inkwell;
using virtual_board::ArmDynamics;
using virtual_board::Matrix3;
using virtual_board::Vector3;

struct Pose {
  Vector3 joints_rad, speeds_rad_s;
};

Pose random_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-1.5, 1.5), speed(-8.0, 8.0);
  return {{angle(random), angle(random), angle(random)}, {speed(random), speed(random), speed(random)}};
}

template <class Check>
void for_poses_of_both_arms(Check&& check) {
  std::mt19937 random(7);
  for (const auto& arm : test::all_arms()) {
    CAPTURE(arm.name);
    const ArmDynamics dynamics(arm);
    for (int i = 0; i < 200; ++i) check(dynamics, random_pose(random));
  }
}

constexpr double h = 1e-6;

}  // namespace

TEST_CASE("the Omni's probe is where the published kinematics put it") {
  const ArmDynamics omni(test::omni());
  const double q1 = 0.3, q2 = 0.7, q3 = -0.2, l = 0.13335;
  const Vector3 p = omni.position_m({q1, q2, q3});
  CHECK(p.x() == doctest::Approx(-std::sin(q1) * l * (std::cos(q2) + std::sin(q3))).epsilon(1e-6));
  CHECK(p.y() == doctest::Approx(l * std::sin(q2) - l * std::cos(q3) + l - 0.110).epsilon(1e-6));
  CHECK(p.z() == doctest::Approx(l * (std::cos(q2) + std::sin(q3)) * std::cos(q1) - l - 0.035).epsilon(1e-6));
}

TEST_CASE("the paper's probe is where Eq. 6 puts it") {
  const ArmDynamics paper(test::paper());
  const double q1 = 0.4, q2 = 0.9, q3 = -1.7, l = 0.14;
  const double reach = l * std::cos(q2) + l * std::cos(q2 + q3);
  const Vector3 p = paper.position_m({q1, q2, q3});
  CHECK(p.x() == doctest::Approx(std::cos(q1) * reach).epsilon(1e-6));
  CHECK(p.y() == doctest::Approx(std::sin(q1) * reach).epsilon(1e-6));
  CHECK(p.z() == doctest::Approx(l * std::sin(q2) + l * std::sin(q2 + q3)).epsilon(1e-6));
}

TEST_CASE("the Jacobian is the position's derivative, so virtual work agrees") {
  for_poses_of_both_arms([](const ArmDynamics& dynamics, const Pose& pose) {
    const auto terms = dynamics.terms(pose.joints_rad, pose.speeds_rad_s);
    const Vector3 change = pose.speeds_rad_s * h;
    const Vector3 moved = dynamics.position_m(pose.joints_rad + change) - dynamics.position_m(pose.joints_rad - change);
    CHECK((terms.jacobian_m * pose.speeds_rad_s - moved / (2 * h)).norm() < 1e-8);
    // tau . dq = F . dx
    const Vector3 force(1.3, -0.7, 2.1);
    const Vector3 torque = terms.jacobian_m.transpose() * force;
    CHECK(torque.dot(2 * change) == doctest::Approx(force.dot(moved)).scale(0).epsilon(1e-4));
  });
}

TEST_CASE("gravity is the gradient of the potential energy") {
  for_poses_of_both_arms([](const ArmDynamics& dynamics, const Pose& pose) {
    const auto terms = dynamics.terms(pose.joints_rad, Vector3::Zero());
    for (int i = 0; i < 3; ++i) {
      const Vector3 change = h * Vector3::Unit(i);
      const double slope = (dynamics.potential_energy_J(pose.joints_rad + change) -
                            dynamics.potential_energy_J(pose.joints_rad - change)) /
                           (2 * h);
      CHECK(std::abs(terms.gravity_Nm[i] - slope) < 1e-8);
    }
  });
}

TEST_CASE("gravity pulls down, along each workspace's own axis") {
  // Only the probe has mass, so the potential energy changes by dV = m g dh.
  for (auto light : test::all_arms()) {
    const int up = light.parameters[protocol::Parameter::frame] == 0.0f ? 2 : 1;
    light.simulation.link_2_mass_kg = light.simulation.link_3_mass_kg = 0.0;
    const ArmDynamics dynamics(light);
    const Vector3 low(0.2, 0.3, -0.5), high(0.2, 0.8, -0.1);
    const double rise_m = dynamics.position_m(high)[up] - dynamics.position_m(low)[up];
    CHECK(rise_m > 0.01);
    CHECK(dynamics.potential_energy_J(high) - dynamics.potential_energy_J(low) ==
          doctest::Approx(0.015 * 9.81 * rise_m).scale(0).epsilon(1e-9));
  }
}

TEST_CASE("the mass matrix is symmetric, positive, and holds a point mass's energy") {
  for_poses_of_both_arms([](const ArmDynamics& dynamics, const Pose& pose) {
    const Matrix3 mass = dynamics.terms(pose.joints_rad, pose.speeds_rad_s).mass_matrix;
    CHECK((mass - mass.transpose()).norm() == 0.0);
    CHECK(Eigen::LLT<Matrix3>(mass).info() == Eigen::Success);
  });
  for (auto arm : test::all_arms()) {
    const ArmDynamics with(arm);
    arm.simulation.probe_mass_kg = 0.0;
    const ArmDynamics without(arm);
    const Vector3 q(0.3, 0.8, -0.9), speed(1.0, -2.0, 3.0);
    const double probe_speed_m_s = (with.terms(q, speed).jacobian_m * speed).norm();
    CHECK(with.kinetic_energy_J(q, speed) - without.kinetic_energy_J(q, speed) ==
          doctest::Approx(0.5 * 0.015 * probe_speed_m_s * probe_speed_m_s).scale(0).epsilon(1e-6));
  }
}

TEST_CASE("Coriolis torques are those of Lagrange's equation for the mass matrix") {
  // c_k = sum_ij (dM_ki/dq_j - dM_ij/dq_k / 2) q_i' q_j'
  for_poses_of_both_arms([](const ArmDynamics& dynamics, const Pose& pose) {
    std::array<Matrix3, 3> slope;
    for (int k = 0; k < 3; ++k) {
      const Vector3 change = h * Vector3::Unit(k);
      slope[k] = (dynamics.terms(pose.joints_rad + change, Vector3::Zero()).mass_matrix -
                  dynamics.terms(pose.joints_rad - change, Vector3::Zero()).mass_matrix) /
                 (2 * h);
    }
    const Vector3& v = pose.speeds_rad_s;
    Vector3 expected = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
      expected += slope[k] * v * v[k];
      expected[k] -= 0.5 * v.dot(slope[k] * v);
    }
    CHECK((dynamics.terms(pose.joints_rad, v).coriolis_Nm - expected).norm() < 1e-8);
  });
}
