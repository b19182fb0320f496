// Tests the detection of a stuck encoder from motor currents and voltages. Healthy encoders must not raise a fault.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "host/lab/campaign/handling.hpp"

#include "tests/system/hazards.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Fault;
using protocol::ForceMode;
using protocol::Parameter;
using protocol::State;

namespace {

Fault fault_of(BoardRig& rig) {
  rig.run(0.01);
  return rig.pose().fault;
}

/// A program pulls for one second while the hand holds the stylus. The force rises to 6 N, falls and rises again.
void pull(BoardRig& rig, const std::array<float, 3>& along) {
  for (int millisecond = 0; millisecond < 1'000; ++millisecond) {
    const float part = std::fmod(0.0015f * static_cast<float>(millisecond), 1.0f);  // phase of the rise and fall
    const float force_N = 12.0f * std::min(part, 1.0f - part);
    rig.push(
        {.force_N = {force_N * along[0], force_N * along[1], force_N * along[2]}, .mode = ForceMode::beside_walls});
  }
}

void make_strong(BoardRig& rig) {
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::force_limit_N, 8.0f}, {Parameter::speed_limit_m_per_s, 10.0f}});
}

}  // namespace

TEST_CASE("slow motion: a joint that a force no longer seems to turn takes it away, and the reference with it") {
  struct Pulled {
    std::string joint;
    std::array<float, 3> along;  ///< a direction in which this motor contributes much of the force
  };
  for (const Pulled& pulled : {Pulled{"1", {1.0f, 0.0f, 0.0f}}, {"2", {0.0f, 0.7f, -0.7f}}, {"3", {0.0f, 0.7f, 0.7f}}})
    for (const bool healthy : {true, false}) {
      CAPTURE(pulled.joint);
      CAPTURE(healthy);
      BoardRig rig;
      make_strong(rig);
      if (!healthy) rig.control.inject({.fault = "encoder_stuck", .of = pulled.joint});
      rig.run(0.2);
      REQUIRE(protocol::force_is_on(rig.pose().state));
      pull(rig, pulled.along);
      CHECK(protocol::info(fault_of(rig)).name ==
            protocol::info(healthy ? Fault::none : Fault::encoder_implausible).name);
      CHECK(bridges_enabled(rig.control) == healthy);
      if (healthy) continue;
      rig.command(protocol::Command::clear_fault);
      rig.run_until([](const auto& pose) { return pose.state == State::unreferenced; });
    }
}

TEST_CASE("a stuck encoder is detected during slow motion into and out of a wall at the usual force limit") {
  for (const bool healthy : {true, false}) {
    CAPTURE(healthy);
    BoardRig rig;
    rig.make_active();
    const auto pressed_m = campaign::beyond_forward_wall_m(rig.device->parameters(), 1.0);
    auto let_go_m = pressed_m;
    let_go_m[2] -= 0.012;
    rig.take_to(let_go_m);
    rig.run(0.3);
    if (!healthy) rig.control.inject({.fault = "encoder_stuck", .of = "2"});
    std::vector<device::HandWaypoint> path;
    for (int i = 0; i < 6; ++i) path.push_back({0.4 * (i + 1), i % 2 == 0 ? pressed_m : let_go_m});
    rig.control.hand_path(path);
    float peak_N = 0.0f;
    for (int i = 0; i < 48; ++i) {
      rig.run(0.05);
      peak_N = std::max(peak_N, rig.pose().force_N[2] * -1.0f);
    }
    CHECK(peak_N > 2.9f);
    CHECK(protocol::info(fault_of(rig)).name ==
          protocol::info(healthy ? Fault::none : Fault::encoder_implausible).name);
    CHECK(bridges_enabled(rig.control) == healthy);
  }
}

TEST_CASE("without force, a motor voltage that contradicts a stuck encoder raises motor_implausible") {
  for (const std::string joint : {"1", "2", "3", "none"}) {
    CAPTURE(joint);
    const bool healthy = joint == "none";
    BoardRig rig;
    make_strong(rig);
    if (!healthy) rig.control.inject({.fault = "encoder_stuck", .of = joint});
    std::vector<device::HandWaypoint> path;
    for (int i = 1; i <= 6; ++i)
      path.push_back({0.09 * i, i % 2 == 0 ? offset_from_free_point(-0.04, -0.03, -0.03)
                                           : offset_from_free_point(0.04, 0.03, 0.03)});
    rig.control.hand_path(path);
    rig.run(0.5);
    CHECK(protocol::info(fault_of(rig)).name == protocol::info(healthy ? Fault::none : Fault::motor_implausible).name);
    CHECK(bridges_enabled(rig.control) == healthy);
    if (healthy) continue;
    rig.command(protocol::Command::clear_fault);
    rig.run_until([](const auto& pose) { return pose.state == State::unreferenced; });
  }
}

TEST_CASE("in the inkwell the arm is stationary although a force pulls it, and no encoder is reported as stuck") {
  BoardRig rig;
  rig.make_active();
  rig.set({{Parameter::force_limit_N, 8.0f}});
  rig.run(0.2);
  pull(rig, {0.6f, 0.0f, 0.0f});
  CHECK(protocol::info(fault_of(rig)).name == protocol::info(Fault::none).name);
  CHECK(largest_current_A(rig.control) > 1.0);
  CHECK(protocol::is_closed(rig.pose().switches, protocol::Switch::inkwell));
}

TEST_CASE("a test's current on a joint that does not seem to turn is no fault: without the force nothing is compared") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.take_to(free_point_m);
  rig.control.inject({.fault = "encoder_stuck", .of = "1"});
  rig.run(0.2);
  rig.device->send(protocol::Command::test_current, {.motor = 1, .amplitude = 1.2f, .duration_s = 0.1f});
  rig.run(0.05);
  CHECK(largest_current_A(rig.control) > 1.1);
  rig.run(0.2);
  CHECK(rig.pose().state == State::ready);
}
