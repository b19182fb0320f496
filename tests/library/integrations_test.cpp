// Runs the examples for ros2_control and CHAI3D on virtual boards, compiled with stand-ins for the headers of the
// frameworks.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <string>

#include "host/bindings/library/examples/chai3d_device.hpp"
#include "host/bindings/library/examples/ros2_control_system.cpp"
#include "tests/dropins/board.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

using hardware_interface::CallbackReturn, hardware_interface::HardwareInfo, hardware_interface::return_type;

/// A board with the stylus in the simulated hand, and an arm object that observes it.
struct HeldBoard : Board {
  VirtualArm watcher{address};
  HeldBoard() {
    watcher.be_patient();
    REQUIRE(inkwell_release(watcher.arm) == INKWELL_OK);
    watcher.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
    hold();
    REQUIRE(inkwell_sleep(watcher.arm, 0.5) == INKWELL_OK);  // until the stylus is stationary
  }
};

TEST_CASE("the ros2_control example reads joints like a URDF, applies efforts and releases the arm") {
  HeldBoard board;
  inkwell_ros::InkwellSystem system;
  const rclcpp_lifecycle::State state;
  const rclcpp::Time time;
  const rclcpp::Duration period;
  CHECK(system.on_init({{}, {{"waist"}}}) == CallbackReturn::ERROR);
  CHECK(rclcpp::newest_text().find("1 joints") != std::string::npos);
  const HardwareInfo info{{{"address", board.address}}, {{"waist"}, {"shoulder"}, {"elbow"}}};
  REQUIRE(system.on_init(info) == CallbackReturn::SUCCESS);
  std::map<std::string, hardware_interface::Handle> states, commands;
  for (auto& each : system.export_state_interfaces()) states.emplace(each.get_name(), each);
  for (auto& each : system.export_command_interfaces()) commands.emplace(each.get_name(), each);
  REQUIRE(states.size() == 10);
  REQUIRE(commands.size() == 3);
  REQUIRE(system.on_configure(state) == CallbackReturn::SUCCESS);
  inkwell_driver driver;
  REQUIRE(inkwell_get_driver(board.watcher.arm, &driver) == INKWELL_OK);
  CHECK(driver.is_driven == 0);
  REQUIRE_MESSAGE(system.on_activate(state) == CallbackReturn::SUCCESS, rclcpp::newest_text());
  REQUIRE(system.read(time, period) == return_type::OK);
  inkwell_pose pose;
  REQUIRE(inkwell_get_pose(board.watcher.arm, &pose) == INKWELL_OK);
  const double elbow_rad = pose.joint_rad[2] - pose.joint_rad[1];
  CHECK(states.at("waist/position").get_value() == doctest::Approx(pose.joint_rad[0]).epsilon(0.01));
  CHECK(states.at("elbow/position").get_value() == doctest::Approx(elbow_rad).epsilon(0.01));
  CHECK(states.at("stylus/received_s").get_value() > 1e9);

  // A force of 1 N up requires these efforts; a positive elbow effort turns link 3 relative to link 2.
  double jacobian[9];
  REQUIRE(inkwell_forward_kinematics(board.watcher.arm, pose.joint_rad, nullptr, jacobian) == INKWELL_OK);
  commands.at("waist/effort").set_value(NAN);
  commands.at("shoulder/effort").set_value(jacobian[3 + 1] + jacobian[3 + 2]);
  commands.at("elbow/effort").set_value(jacobian[3 + 2]);
  int poses = 0;
  pose = board.watcher.wait_until([&](const auto&) {
    REQUIRE(system.read(time, period) == return_type::OK);
    REQUIRE_MESSAGE(system.write(time, period) == return_type::OK, rclcpp::newest_text());
    return ++poses == 500;
  });
  CHECK(std::abs(pose.force_N[0]) < 0.05);
  CHECK(std::abs(pose.force_N[1] - 1.0) < 0.05);
  CHECK(std::abs(pose.force_N[2]) < 0.05);
  CHECK(std::abs(states.at("elbow/effort").get_value() - jacobian[3 + 2]) < 0.01);
  CHECK(std::abs(states.at("shoulder/effort").get_value() - jacobian[3 + 1] - jacobian[3 + 2]) < 0.01);

  REQUIRE(inkwell_stop(board.watcher.arm) == INKWELL_OK);
  board.watcher.wait_until([&](const auto&) { return system.write(time, period) == return_type::ERROR; });
  CHECK(rclcpp::newest_text().find("switched the force off") != std::string::npos);
  REQUIRE(system.on_deactivate(state) == CallbackReturn::SUCCESS);
  REQUIRE(inkwell_get_driver(board.watcher.arm, &driver) == INKWELL_OK);
  CHECK(driver.is_driven == 0);
  board.control.usb(false);
  while (system.read(time, period) == return_type::OK) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  CHECK(system.on_cleanup(state) == CallbackReturn::SUCCESS);
}

TEST_CASE("the CHAI3D example has the axes of CHAI3D, renders forces and describes the device") {
  HeldBoard board;
  const auto device = chai3d::cInkwellDevice::create(board.address);
  chai3d::cVector3d position_m, force_N(0, 0, 1);
  CHECK(device->getPosition(position_m) == chai3d::C_ERROR);
  REQUIRE_MESSAGE(device->open() == chai3d::C_SUCCESS, std::string(inkwell_error_text()));
  CHECK(device->open() == chai3d::C_ERROR);
  const auto specifications = device->getSpecifications();
  CHECK(specifications.m_maxLinearForce > 0.1);
  CHECK(specifications.m_maxLinearStiffness > 100);
  CHECK(specifications.m_workspaceRadius == doctest::Approx(0.065).epsilon(0.001));
  REQUIRE(device->getPosition(position_m) == chai3d::C_SUCCESS);
  CHECK(position_m.x() == doctest::Approx(held_point_m[2]).epsilon(0.005));
  CHECK(position_m.y() == doctest::Approx(held_point_m[0]).epsilon(0.005));
  CHECK(position_m.z() == doctest::Approx(held_point_m[1]).epsilon(0.005));
  chai3d::cMatrix3d rotation;
  REQUIRE(device->getRotation(rotation) == chai3d::C_SUCCESS);
  inkwell_pose pose;
  REQUIRE(inkwell_get_pose(board.watcher.arm, &pose) == INKWELL_OK);
  CHECK(rotation(0, 0) == doctest::Approx(pose.rotation[8]).epsilon(0.01));  // along the stylus, to the user
  CHECK(rotation(2, 1) == doctest::Approx(pose.rotation[3]).epsilon(0.01));
  board.watcher.wait_until([&](const auto& now) {
    REQUIRE_MESSAGE(device->setForce(force_N) == chai3d::C_SUCCESS, std::string(inkwell_error_text()));
    return now.force_N[1] > 0.95 && std::abs(now.force_N[0]) < 0.05;
  });
  board.control.buttons(false, true);
  unsigned int switches = 0;
  while (switches == 0) REQUIRE(device->getUserSwitches(switches) == chai3d::C_SUCCESS);
  CHECK(switches == 2);
  chai3d::cVector3d velocity;
  CHECK(device->getLinearVelocity(velocity) == chai3d::C_SUCCESS);
  CHECK(device->getAngularVelocity(velocity) == chai3d::C_SUCCESS);

  REQUIRE(inkwell_stop(board.watcher.arm) == INKWELL_OK);
  while (device->setForce(force_N) == chai3d::C_SUCCESS) board.watcher.wait_until([](const auto&) { return true; });
  REQUIRE(device->close() == chai3d::C_SUCCESS);
  CHECK(device->close() == chai3d::C_ERROR);
}

}  // namespace
}  // namespace inkwell::tests
