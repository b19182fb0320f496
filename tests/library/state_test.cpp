// Tests states, abilities and joint torques through the C interface.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <ctime>

#include <inkwell/inkwell.h>
#include "firmware/control/settings.hpp"
#include "tests/dropins/board.hpp"

#include "host/bindings/library/pose_reader.hpp"
#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

std::int64_t now_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

inkwell_arm_state state_of(inkwell_arm* arm) {
  inkwell_arm_state state;
  REQUIRE_MESSAGE(inkwell_get_state(arm, &state, sizeof state) == INKWELL_OK, std::string(inkwell_error_text()));
  return state;
}

/// An absolute tolerance for values up to about 1.
doctest::Approx near(double value, double tolerance) { return doctest::Approx(value).epsilon(tolerance); }

TEST_CASE("a state has the pose, its validity, and the host's time of its arrival") {
  const std::int64_t begin_ns = now_ns(CLOCK_REALTIME), begin_monotonic_ns = now_ns(CLOCK_MONOTONIC);
  VirtualArm virtual_arm("virtual?seed=3");  // board time passes only while a call waits
  inkwell_arm* arm = virtual_arm.arm;
  inkwell_pose pose;
  REQUIRE(inkwell_wait_for_pose(arm, 10, &pose) == INKWELL_OK);
  const inkwell_arm_state state = state_of(arm);
  CHECK(std::memcmp(&state.pose, &pose, sizeof pose) == 0);
  CHECK(state.is_referenced == 1);
  CHECK(state.received_ns > begin_ns);
  CHECK(state.received_ns < now_ns(CLOCK_REALTIME));
  CHECK(state.received_monotonic_ns > begin_monotonic_ns);
  CHECK(state.received_monotonic_ns < now_ns(CLOCK_MONOTONIC));
  REQUIRE(inkwell_wait_for_pose(arm, 10, &pose) == INKWELL_OK);
  CHECK(state_of(arm).received_monotonic_ns > state.received_monotonic_ns);
}

TEST_CASE("a state of another library version is cut or filled with zeros, and a too small state is refused") {
  VirtualArm virtual_arm("virtual?seed=3");
  struct {
    inkwell_arm_state state;
    double later[2];
  } newer{};
  newer.later[1] = 7;
  REQUIRE(inkwell_get_state(virtual_arm.arm, &newer.state, sizeof newer) == INKWELL_OK);
  CHECK(newer.later[1] == 0);
  const inkwell_arm_state known = state_of(virtual_arm.arm);
  CHECK(std::memcmp(&newer.state, &known, sizeof known) == 0);
  CHECK(inkwell_get_state(virtual_arm.arm, &newer.state, sizeof(inkwell_pose)) == INKWELL_BAD_ARGUMENT);
  CHECK(says("sizeof(inkwell_arm_state)"));
  CHECK(inkwell_get_state(virtual_arm.arm, nullptr, sizeof newer.state) == INKWELL_BAD_ARGUMENT);
  inkwell_abilities abilities;
  CHECK(inkwell_get_abilities(virtual_arm.arm, &abilities, sizeof(double)) == INKWELL_BAD_ARGUMENT);
}

TEST_CASE("a state without referenced encoders is marked as not valid and has no speed") {
  Board board({.paused = true});
  VirtualArm arm(board.address);
  const inkwell_arm_state state = state_of(arm.arm);
  CHECK(state.is_referenced == 0);
  for (const double speed : state.joint_speed_rad_per_s) CHECK(speed == 0.0);
  for (const double speed : state.angular_velocity_rad_per_s) CHECK(speed == 0.0);
  for (const double torque : state.joint_torque_Nm) CHECK(torque == 0.0);
}

TEST_CASE("joint speeds agree with the velocity, joint torques with the force, and the quaternion with the rotation") {
  VirtualArm virtual_arm("virtual?seed=5");
  inkwell_arm* arm = virtual_arm.arm;
  virtual_arm.make_active();
  REQUIRE(inkwell_sleep(arm, 0.5) == INKWELL_OK);  // until the stylus is stationary
  const double force_N[3]{0.8, 0, 0};
  int moving = 0;
  for (int i = 0; i < 200; ++i) {
    const double target_m[3]{1e-4 * i, 5e-5 * i, -0.03};  // 0.1 m/s
    REQUIRE(inkwell_move_virtual_hand(arm, target_m, hand_N_per_m) == INKWELL_OK);
    REQUIRE(inkwell_set_force(arm, force_N) == INKWELL_OK);
    inkwell_pose pose;
    REQUIRE(inkwell_wait_for_pose(arm, 10, &pose) == INKWELL_OK);
    const inkwell_arm_state state = state_of(arm);
    double jacobian[9];
    REQUIRE(inkwell_forward_kinematics(arm, state.pose.joint_rad, nullptr, jacobian) == INKWELL_OK);
    for (int row = 0; row < 3; ++row) {
      double speed_m_per_s = 0, torque_Nm = 0;
      for (int column = 0; column < 3; ++column) {
        speed_m_per_s += jacobian[3 * row + column] * state.joint_speed_rad_per_s[column];
        torque_Nm += jacobian[3 * column + row] * state.pose.force_N[column];
      }
      CHECK(speed_m_per_s == near(state.pose.velocity_m_s[row], 0.02));
      CHECK(state.joint_torque_Nm[row] == near(torque_Nm, 1e-5));
    }
    if (std::abs(state.pose.velocity_m_s[0]) > 0.05) ++moving;
    const double* q = state.quaternion;
    CHECK(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] == near(1, 1e-5));
    CHECK(q[3] >= 0);
    CHECK(state.pose.rotation[0] == near(1 - 2 * (q[1] * q[1] + q[2] * q[2]), 1e-5));
    CHECK(state.pose.rotation[3] == near(2 * (q[0] * q[1] + q[2] * q[3]), 1e-5));
    CHECK(state.pose.rotation[6] == near(2 * (q[0] * q[2] - q[1] * q[3]), 1e-5));
  }
  CHECK(moving > 10);
}

TEST_CASE("the angular velocity is that of the stylus: joint 1 turns it to the left, the roll about its axis") {
  const control::Arm geometry = control::prepare(protocol::default_parameters()).arm;
  for (const bool is_roll : {false, true}) {
    CAPTURE(is_roll);
    library::PoseReader reader;
    device::Pose report{};
    report.is_referenced = true;
    report.joint_rad[1] = 0.5f;
    inkwell_pose pose{};
    for (int i = 0; i < 40; ++i) {
      report.time_periods += protocol::servo_rate_Hz / 1000;
      (is_roll ? report.gimbal_rad[2] : report.joint_rad[0]) += 0.002f;
      pose = reader.read(report, geometry);
    }
    const auto& motion = reader.motion();
    CHECK(motion.joint_speed_rad_per_s[0] == near(is_roll ? 0 : 2, 0.01));
    for (std::size_t i = 0; i < 3; ++i) {
      const double axis = is_roll ? pose.rotation[3 * i + 2] : i == 1 ? -1.0 : 0.0;
      CHECK(std::abs(motion.angular_velocity_rad_per_s[i]) == near(std::abs(2 * axis), 0.01));
      if (!is_roll && i == 1) CHECK(motion.angular_velocity_rad_per_s[i] < 0);
    }
  }
}

TEST_CASE("abilities follow from the parameters, and every position of the workspace is in reach") {
  VirtualArm virtual_arm;
  inkwell_arm* arm = virtual_arm.arm;
  const char* const limit = "force_limit_N";
  const double limit_N = 2.5;
  REQUIRE(inkwell_set_parameters(arm, &limit, &limit_N, 1) == INKWELL_OK);
  inkwell_abilities abilities;
  REQUIRE(inkwell_get_abilities(arm, &abilities, sizeof abilities) == INKWELL_OK);
  const auto parameter = [&](const char* name) {
    double value = 0;
    REQUIRE(inkwell_get_parameter(arm, name, &value) == INKWELL_OK);
    return value;
  };
  CHECK(abilities.force_N == 2.5);
  CHECK(abilities.continuous_force_N > 0.1);
  CHECK(abilities.continuous_force_N <= abilities.force_N);
  CHECK(abilities.workspace_minimum_m[2] == parameter("box_minimum_z_m"));
  CHECK(abilities.workspace_maximum_m[0] == parameter("box_maximum_x_m"));
  CHECK(abilities.workspace_radius_m == near(0.065, 1e-6));  // half of the depth of 0.13 m
  for (int i = 0; i < 3; ++i) {
    CHECK(abilities.reach_minimum_m[i] < abilities.workspace_minimum_m[i] + 0.03);
    CHECK(abilities.reach_maximum_m[i] > abilities.workspace_maximum_m[i] - 0.03);
    CHECK(abilities.continuous_joint_torque_Nm[i] < abilities.joint_torque_Nm[i]);
  }
  CHECK(abilities.joint_minimum_rad[0] == parameter("joint_1_minimum_rad"));
  CHECK(abilities.joint_maximum_rad[2] == parameter("elbow_maximum_rad"));
  CHECK(abilities.third_joint_is_absolute == 1);
  CHECK(abilities.joint_torque_Nm[1] == near(0.0234 * 11.2 * 2.5, 1e-5));
  CHECK(abilities.stiffness_N_per_m > 100);
  CHECK(abilities.damping_Ns_per_m > 0);
  CHECK(abilities.pose_rate_Hz == 1000);
}

TEST_CASE("joint signs: joint 1 is positive to the left, joint 2 upward, joint 3 toward the user and upward") {
  VirtualArm virtual_arm;
  const auto probe = [&](double joint_1, double joint_2, double joint_3) {
    const double joint_rad[3]{joint_1, joint_2, joint_3};
    std::array<double, 3> position_m{};
    REQUIRE(inkwell_forward_kinematics(virtual_arm.arm, joint_rad, position_m.data(), nullptr) == INKWELL_OK);
    return position_m;
  };
  const auto zero_m = probe(0, 0, 0);
  CHECK(zero_m[0] == near(0, 1e-6));
  CHECK(probe(0.1, 0, 0)[0] < -0.01);
  CHECK(probe(0, 0.1, 0)[1] > zero_m[1] + 0.01);
  CHECK(probe(0, 0.1, 0)[2] < zero_m[2]);  // link 3 keeps its direction
  CHECK(probe(0, 0, 0.1)[2] > zero_m[2] + 0.01);
  CHECK(probe(0, 0, 0.1)[1] > zero_m[1]);
}

TEST_CASE("joint torques act as the force that requires them, and a stretched arm refuses them") {
  VirtualArm virtual_arm;
  inkwell_arm* arm = virtual_arm.arm;
  virtual_arm.make_active();
  inkwell_pose pose;
  REQUIRE(inkwell_get_pose(arm, &pose) == INKWELL_OK);
  double jacobian[9];
  REQUIRE(inkwell_forward_kinematics(arm, pose.joint_rad, nullptr, jacobian) == INKWELL_OK);
  const double wanted_N[3]{0.4, 0.6, -0.3};
  double torque_Nm[3]{}, force_N[3]{};
  for (int joint = 0; joint < 3; ++joint)
    for (int axis = 0; axis < 3; ++axis) torque_Nm[joint] += jacobian[3 * axis + joint] * wanted_N[axis];
  REQUIRE(inkwell_force_of_torques(arm, pose.joint_rad, torque_Nm, force_N) == INKWELL_OK);
  for (int i = 0; i < 3; ++i) CHECK(force_N[i] == near(wanted_N[i], 1e-4));

  for (int i = 0; i < 400; ++i) {
    REQUIRE_MESSAGE(inkwell_set_joint_torques(arm, torque_Nm) == INKWELL_OK, std::string(inkwell_error_text()));
    REQUIRE(inkwell_wait_for_pose(arm, 10, &pose) == INKWELL_OK);
  }
  for (int i = 0; i < 3; ++i) CHECK(pose.force_N[i] == near(wanted_N[i], 0.05));

  const double straight_rad[3]{0, 0.5, 0.5 + std::acos(0.0)};
  CHECK(inkwell_force_of_torques(arm, straight_rad, torque_Nm, force_N) == INKWELL_REFUSED);
  CHECK(says("stretched"));
  CHECK(force_N[0] == 0.0);
  const double bad[3]{0, NAN, 0};
  CHECK(inkwell_set_joint_torques(arm, bad) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_force_of_torques(arm, bad, torque_Nm, force_N) == INKWELL_BAD_ARGUMENT);
}

TEST_CASE("a claim is a separate step, and a release lets another program drive without a lost force") {
  Board board;
  VirtualArm first(board.address), second(board.address);
  first.be_patient();
  first.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  REQUIRE(inkwell_release(first.arm) == INKWELL_OK);  // changes of parameters do not need a claim to be released
  REQUIRE(inkwell_claim(first.arm) == INKWELL_OK);
  inkwell_driver driver;
  REQUIRE(inkwell_get_driver(second.arm, &driver) == INKWELL_OK);
  CHECK(driver.is_driven == 1);
  CHECK(state_of(first.arm).pose.state == INKWELL_READY);
  CHECK(inkwell_claim(second.arm) == INKWELL_IN_USE);
  board.hold();
  REQUIRE(inkwell_enable_force(first.arm, 30) == INKWELL_OK);
  const auto go_on = [](inkwell_arm*, const inkwell_pose*, double*, void*) { return 0; };
  REQUIRE(inkwell_start_servo(first.arm, go_on, nullptr) == INKWELL_OK);
  CHECK(inkwell_release(first.arm) == INKWELL_REFUSED);
  CHECK(says("servo is running"));
  REQUIRE(inkwell_stop_servo(first.arm) == INKWELL_OK);
  REQUIRE_MESSAGE(inkwell_release(first.arm) == INKWELL_OK, std::string(inkwell_error_text()));
  first.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  REQUIRE(inkwell_get_driver(first.arm, &driver) == INKWELL_OK);
  CHECK(driver.is_driven == 0);

  REQUIRE(inkwell_claim(second.arm) == INKWELL_OK);
  const double none_N[3]{};
  CHECK(inkwell_set_force(first.arm, none_N) == INKWELL_IN_USE);
  REQUIRE(inkwell_release(second.arm) == INKWELL_OK);
  for (int i = 0; i < 50; ++i) first.wait_until([](const auto&) { return true; });
  CHECK_MESSAGE(inkwell_set_force(first.arm, none_N) == INKWELL_OK, std::string(inkwell_error_text()));
}

}  // namespace
}  // namespace inkwell::tests
