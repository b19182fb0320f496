// What keeps a hand safe: no force before the reference, none without a host, bridges off on a fault.
#include <doctest/doctest.h>

#include <cmath>

#include "rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;
using protocol::State;

namespace {

double largest_current_A(device::ControlClient& control) {
  const auto truth = control.truth();
  double largest = 0;
  for (const char* name : {"true_current_1_A", "true_current_2_A", "true_current_3_A"})
    largest = std::max(largest, std::abs(truth.at(name).get<double>()));
  return largest;
}

}  // namespace

TEST_CASE("an arm that has not been in the inkwell gets no force") {
  Rig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.take_to(free_point_m);
  rig.device.reset();
  rig.control.reset();
  rig.control.run(0.02);  // long enough for the bus to see that the device is gone
  rig.control.resume();
  std::optional<device::Endpoint> endpoint;
  while (!endpoint) endpoint = rig.board.find();
  rig.device = device::Device::open(*endpoint);
  rig.device->set_parameters(std::vector<device::ParameterChange>{{Parameter::host_timeout_s, 2.0f}});
  rig.control.pause();
  rig.run(0.3);
  CHECK(rig.pose().state == State::unreferenced);
  rig.command(protocol::Command::enable_force);
  rig.run(0.3);
  CHECK(rig.pose().state == State::unreferenced);
  CHECK(largest_current_A(rig.control) < 0.02);

  // Back in the inkwell it learns where it is.
  rig.control.dock(true);
  rig.control.hand({.holds = false});
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
}

TEST_CASE("the force goes off when the host falls silent") {
  Rig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::box_minimum_z_m, -0.015f}});  // inside the wall
  rig.run(0.1);
  CHECK(largest_current_A(rig.control) > 0.1);
  rig.set({{Parameter::host_timeout_s, 0.05f}});
  rig.control.run(0.1);  // no sign of life
  CHECK(largest_current_A(rig.control) < 0.02);
  rig.run(0.02);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == protocol::Fault::host_silent);
}

TEST_CASE("a supply that fails switches the bridges off and says so") {
  Rig rig;
  rig.make_active();
  rig.control.supply(9.0);  // the board's capacitors hold the bridges up for a while
  rig.run_until([](const auto& pose) { return pose.state == State::fault; });
  CHECK(rig.pose().fault == protocol::Fault::supply_low);
  CHECK(largest_current_A(rig.control) < 0.02);
  rig.control.supply(18.0);
  rig.run(0.3);
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
}

TEST_CASE("refused parameters do not move a motor") {
  Rig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  for (float value : {std::nanf(""), 1e30f, -1e30f}) {
    rig.call([&](device::Device& arm) {
      CHECK_THROWS_AS(
          arm.set_parameters(std::vector<device::ParameterChange>{{Parameter::wall_stiffness_N_per_m, value}}),
          device::Refused);
    });
    rig.run(0.05);
    CHECK(largest_current_A(rig.control) < 0.05);
  }
}
