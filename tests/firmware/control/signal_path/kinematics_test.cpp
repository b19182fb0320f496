// Compares kinematics and virtual work with independent rotation matrices in double precision. The paper's arm uses
// Denavit-Hartenberg transforms. The Omni uses the transforms published by the Ubitrack project.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/firmware/control/arms.hpp"

#ifdef INKWELL_ON_PC
#include <Eigen/Dense>
#endif

namespace {

using namespace inkwell;
using control::Triple;
using control::Vector3;
using protocol::Parameter;

#ifdef INKWELL_ON_PC
constexpr int pose_count = 100'000;
#else
constexpr int pose_count = 100;  // double precision is slow there
#endif

struct Point {
  double x, y, z;
};
using Joints = std::array<double, 3>;

double distance(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }
Point point(const Vector3& v) { return {v.x, v.y, v.z}; }
Joints joints(const Triple& t) { return {t[0], t[1], t[2]}; }

/// The published Omni kinematics use an absolute third angle and the origin of the arm description.
Point omni_reference(const Joints& q, const protocol::ParameterSet& set) {
  const double l1 = set[Parameter::link_2_m], l2 = set[Parameter::link_3_m];
  const double s1 = std::sin(q[0]), c1 = std::cos(q[0]);
  const double s3 = std::sin(q[2]), c3 = std::cos(q[2]);
  return {-s1 * (l1 * std::cos(q[1]) + l2 * s3) + set[Parameter::origin_x_m],
          l1 * std::sin(q[1]) - l2 * c3 + set[Parameter::origin_y_m],
          (l1 * std::cos(q[1]) + l2 * s3) * c1 + set[Parameter::origin_z_m]};
}

/// Eq. 6 of the paper.
Point paper_reference(const Joints& q, const protocol::ParameterSet& set) {
  const double a2 = set[Parameter::link_2_m], a3 = set[Parameter::link_3_m];
  const double reach = a2 * std::cos(q[1]) + a3 * std::cos(q[1] + q[2]);
  return {std::cos(q[0]) * reach, std::sin(q[0]) * reach, a2 * std::sin(q[1]) + a3 * std::sin(q[1] + q[2])};
}

using Reference = Point (*)(const Joints&, const protocol::ParameterSet&);

struct ArmCase {
  std::string name;
  protocol::ParameterSet parameters;
  Reference reference;
};

/// Joint 1 rotates the plane of links 2 and 3. All arm descriptions in boards/arms/ have this geometry.
Point family_reference(const Joints& q, const protocol::ParameterSet& set) {
  const double phi_2 = q[1];
  const double phi_3 = q[2] + set[Parameter::elbow_offset_rad] + (set[Parameter::transmission] == 0.0f ? q[1] : 0.0);
  const double l2 = set[Parameter::link_2_m], l3 = set[Parameter::link_3_m];
  const double reach = l2 * std::cos(phi_2) + l3 * std::cos(phi_3);
  const double height = l2 * std::sin(phi_2) + l3 * std::sin(phi_3);
  const double forward = reach * std::cos(q[0]), side = reach * std::sin(q[0]);
  const Point origin{set[Parameter::origin_x_m], set[Parameter::origin_y_m], set[Parameter::origin_z_m]};
  if (set[Parameter::frame] == 0.0f) return {origin.x + forward, origin.y + side, origin.z + height};
  return {origin.x - side, origin.y + height, origin.z + forward};
}

/// Returns all described arms, and the two published arms with their published kinematics.
std::vector<ArmCase> arm_cases() {
  std::vector<ArmCase> cases{{"published Omni", tests::omni_parameters(), omni_reference},
                             {"published paper", tests::paper_parameters(), paper_reference}};
  for (const auto& [name, parameters] : tests::all_arms())
    cases.push_back({std::string(name), parameters, family_reference});
  return cases;
}

/// Returns dx/dq of the reference by fourth-order central differences, with an error of about 1e-11.
std::array<Point, 3> reference_jacobian(const ArmCase& arm, const Joints& q) {
  constexpr double h = 1e-3;
  std::array<Point, 3> columns{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = [&](double steps) {
      Joints moved = q;
      moved[i] += steps * h;
      return arm.reference(moved, arm.parameters);
    };
    const Point a = at(-2), b = at(-1), c = at(1), d = at(2);
    const auto slope = [](double m2, double m1, double p1, double p2) {
      return (m2 - 8 * m1 + 8 * p1 - p2) / (12 * h);
    };
    columns[i] = {slope(a.x, b.x, c.x, d.x), slope(a.y, b.y, c.y, d.y), slope(a.z, b.z, c.z, d.z)};
  }
  return columns;
}

TEST_CASE("position within 1 um and torques within 1e-4 of a double reference, every arm") {
  for (const ArmCase& arm : arm_cases()) {
    CAPTURE(arm.name);
    const control::Settings settings = control::prepare(arm.parameters);
    tests::Random random{1};
    double worst_position_m = 0, worst_torque = 0;
    for (int i = 0; i < pose_count; ++i) {
      const Triple q = tests::random_joints(arm.parameters, random);
      const Vector3 force{random.between(-3.3f, 3.3f), random.between(-3.3f, 3.3f), random.between(-3.3f, 3.3f)};
      const control::Pose pose = control::forward_kinematics(q, settings.arm);
      worst_position_m =
          std::max(worst_position_m, distance(point(pose.position_m), arm.reference(joints(q), arm.parameters)));

      const Triple torque = control::joint_torques(pose.jacobian, force);
      const std::array<Point, 3> columns = reference_jacobian(arm, joints(q));
      double error_squared = 0, size_squared = 0;
      for (std::size_t joint = 0; joint < 3; ++joint) {
        const Point& c = columns[joint];
        const double expected = c.x * force.x + c.y * force.y + c.z * force.z;
        error_squared += (torque[joint] - expected) * (torque[joint] - expected);
        size_squared += expected * expected;
      }
      worst_torque = std::max(worst_torque, std::sqrt(error_squared / size_squared));
    }
    MESSAGE(arm.name << ": worst position error " << worst_position_m * 1e6 << " um, worst torque error "
                     << worst_torque << " of the torque");
    CHECK(worst_position_m < 1e-6);
    CHECK(worst_torque < 1e-4);
  }
}

TEST_CASE("virtual work: the torques' work in the joints is the force's work at the probe") {
  for (const ArmCase& arm : arm_cases()) {
    CAPTURE(arm.name);
    const control::Settings settings = control::prepare(arm.parameters);
    tests::Random random{2};
    double worst = 0;
    for (int i = 0; i < pose_count / 10; ++i) {
      const Triple q = tests::random_joints(arm.parameters, random);
      const Vector3 force{random.between(-3.3f, 3.3f), random.between(-3.3f, 3.3f), random.between(-3.3f, 3.3f)};
      const Triple torque = control::joint_torques(control::forward_kinematics(q, settings.arm).jacobian, force);
      Joints before = joints(q), after = joints(q);
      double work_in_joints = 0, torque_size = 0;
      constexpr double step_rad = 1e-4;
      for (std::size_t joint = 0; joint < 3; ++joint) {
        const double dq = step_rad * static_cast<double>(random.between(-1.0f, 1.0f));
        before[joint] -= dq / 2;
        after[joint] += dq / 2;
        work_in_joints += torque[joint] * dq;
        torque_size = std::max(torque_size, std::abs(static_cast<double>(torque[joint])));
      }
      const Point a = arm.reference(before, arm.parameters), b = arm.reference(after, arm.parameters);
      const double work_at_probe = force.x * (b.x - a.x) + force.y * (b.y - a.y) + force.z * (b.z - a.z);
      worst = std::max(worst, std::abs(work_in_joints - work_at_probe) / (torque_size * step_rad));
    }
    CHECK(worst < 1e-5);
  }
}

TEST_CASE("without one of the links' torques the force is the nearest that needs none, so never larger") {
  for (const ArmCase& arm : arm_cases()) {
    CAPTURE(arm.name);
    const control::Settings settings = control::prepare(arm.parameters);
    tests::Random random{4};
    float worst_Nm = 0.0f;
    for (int i = 0; i < pose_count / 10; ++i) {
      const Triple q = tests::random_joints(arm.parameters, random);
      const Vector3 force_N{random.between(-3.3f, 3.3f), random.between(-3.3f, 3.3f), random.between(-3.3f, 3.3f)};
      const control::Jacobian jacobian = control::forward_kinematics(q, settings.arm).jacobian;
      const Triple whole_Nm = control::joint_torques(jacobian, force_N);
      for (const std::size_t idle : {1u, 2u}) {
        const Vector3& way = jacobian.column[idle];
        if (control::dot(way, way) < 1e-4f) continue;
        const Vector3 nearest_N = force_N - (control::dot(force_N, way) / control::dot(way, way)) * way;
        const Triple nearest_Nm = control::joint_torques(jacobian, nearest_N);
        Triple torque_Nm = whole_Nm;
        control::remove_idle_torque(idle, torque_Nm, jacobian);
        for (std::size_t joint = 0; joint < 3; ++joint)
          worst_Nm = std::max(worst_Nm, std::fabs(torque_Nm[joint] - nearest_Nm[joint]));
      }
    }
    CHECK(worst_Nm < 1e-5f);
  }
}

TEST_CASE("the links' ends: constant lengths, and the last one is the probe") {
  for (const ArmCase& arm : arm_cases()) {
    CAPTURE(arm.name);
    const control::Settings settings = control::prepare(arm.parameters);
    tests::Random random{3};
    for (int i = 0; i < 100; ++i) {
      const Triple q = tests::random_joints(arm.parameters, random);
      const control::LinkEnds ends = control::link_ends(q, settings.arm);
      const control::Pose pose = control::forward_kinematics(q, settings.arm);
      CHECK(ends.shoulder_m == settings.arm.origin_m);
      CHECK(distance(point(ends.probe_m), point(pose.position_m)) < 1e-7);
      const double link_2_m = distance(point(ends.shoulder_m), point(ends.elbow_m));
      const double link_3_m = distance(point(ends.elbow_m), point(ends.probe_m));
      CHECK(link_2_m == doctest::Approx(settings.arm.link_2_m).epsilon(1e-6));
      CHECK(link_3_m == doctest::Approx(settings.arm.link_3_m).epsilon(1e-6));
    }
  }
}

/// Equations 10 to 15 of the paper, with L1 = 0. The equations are exact for joint 1 of a serial arm. For joints 2 and
/// 3, the equations are exact only at q1 = pi/2.
Triple paper_torques(const control::LinkEnds& ends, const Vector3& force_N) {
  const Vector3 link_2_m = ends.elbow_m - ends.shoulder_m;
  const Vector3 link_3_m = ends.probe_m - ends.elbow_m;
  return {cross(link_2_m + link_3_m, force_N).z, cross(link_2_m + link_3_m, force_N).x, cross(link_3_m, force_N).x};
}

TEST_CASE("the paper's Eq. 10 to 15 equal virtual work at theta1 = pi/2, and only T1z elsewhere") {
  const protocol::ParameterSet parameters = tests::paper_parameters();
  const control::Arm arm = control::prepare(parameters).arm;
  tests::Random random{4};
  float largest_difference_elsewhere_Nm = 0.0f;
  for (int i = 0; i < 200; ++i) {
    Triple q = tests::random_joints(parameters, random);
    const Vector3 force{random.between(-3.3f, 3.3f), random.between(-3.3f, 3.3f), random.between(-3.3f, 3.3f)};
    const auto ours = [&] { return control::joint_torques(control::forward_kinematics(q, arm).jacobian, force); };
    const auto papers = [&] { return paper_torques(control::link_ends(q, arm), force); };
    CHECK(ours()[0] == doctest::Approx(papers()[0]).epsilon(1e-4).scale(0.1));
    largest_difference_elsewhere_Nm = std::max(largest_difference_elsewhere_Nm, std::abs(ours()[1] - papers()[1]));
    q[0] = 1.5707963f;
    for (std::size_t joint = 0; joint < 3; ++joint) CHECK(std::abs(ours()[joint] - papers()[joint]) < 1e-6f);
  }
  CHECK(largest_difference_elsewhere_Nm > 0.1f);
}

TEST_CASE("a force in the x-z plane requires no torque of motor 1 of the paper arm") {
  const control::Arm arm = control::prepare(tests::paper_parameters()).arm;
  const control::Pose pose = control::forward_kinematics({0.0f, 0.9f, -1.7f}, arm);
  const Triple torque = control::joint_torques(pose.jacobian, {2.0f, 0.0f, -1.0f});
  CHECK(torque[0] == 0.0f);
  CHECK(std::abs(torque[1]) > 0.01f);
}

TEST_CASE("the elbow's angle between the links is relative on every arm") {
  CHECK(control::elbow_rad({0.1f, 0.5f, 0.7f}, control::Transmission::serial) == 0.7f);
  CHECK(control::elbow_rad({0.1f, 0.5f, 0.7f}, control::Transmission::parallelogram) == doctest::Approx(0.2f));
}

#ifdef INKWELL_ON_PC
TEST_CASE("the reference of the paper is the product of its Denavit-Hartenberg transforms (Eq. 1 to 6)") {
  const protocol::ParameterSet set = tests::paper_parameters();
  const auto link = [](double a, double alpha, double theta) {
    return Eigen::Isometry3d(Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(a, 0, 0) *
                             Eigen::AngleAxisd(alpha, Eigen::Vector3d::UnitX()));
  };
  tests::Random random{5};
  for (int i = 0; i < 1000; ++i) {
    const Joints q = joints(tests::random_joints(set, random));
    const Eigen::Isometry3d chain = link(0, std::acos(0.0), q[0]) * link(set[Parameter::link_2_m], 0, q[1]) *
                                    link(set[Parameter::link_3_m], 0, q[2]);
    const Eigen::Vector3d end = chain.translation();
    CHECK(distance(paper_reference(q, set), {end.x(), end.y(), end.z()}) < 1e-12);
  }
}
#endif

}  // namespace
