// Tests two reasons for an invalid reference: a jump of an encoder, and a closed inkwell switch outside the inkwell.
#include <doctest/doctest.h>

#include <string>

#include "tests/system/hazards.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Fault;
using protocol::State;

namespace {

void check_reported(BoardRig& rig, Fault fault) {
  rig.run(0.02);
  CHECK(rig.pose().state == State::fault);
  CHECK(protocol::info(rig.pose().fault).name == protocol::info(fault).name);
  CHECK_FALSE(bridges_enabled(rig.control));
}

void clear(BoardRig& rig) {
  rig.command(protocol::Command::clear_fault);
  rig.run(0.02);
}

/// Puts the stylus into the inkwell and waits for the reference.
void put_into_inkwell(BoardRig& rig) {
  rig.control.dock(true);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
}

}  // namespace

TEST_CASE("an encoder jump is reported as encoder_implausible at any time within a control period") {
  BoardRig rig;
  constexpr int parts = 6;
  for (int part = 0; part < parts; ++part) {
    CAPTURE(part);
    rig.make_active();
    rig.take_to(free_point_m);
    rig.run(0.2);
    REQUIRE(protocol::force_is_on(rig.pose().state));
    rig.control.inject({.fault = "encoder_slip",
                        .of = std::to_string(1 + part % 3),
                        .amount = part % 2 == 0 ? 400.0 : -400.0,
                        .after_s = control_period_s * part / parts});
    check_reported(rig, Fault::encoder_implausible);
    clear(rig);
    CHECK(rig.pose().state == State::unreferenced);
    put_into_inkwell(rig);
  }
}

TEST_CASE("an encoder slip during another fault also clears the reference") {
  BoardRig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  rig.control.inject({.fault = "bridge_fault", .for_s = 0.01});
  check_reported(rig, Fault::bridge_fault);
  rig.control.inject({.fault = "encoder_slip", .of = "2"});
  check_reported(rig, Fault::bridge_fault);
  clear(rig);
  CHECK(rig.pose().state == State::unreferenced);
}

TEST_CASE("an inkwell switch with a wire at ground raises a fault and sets no reference until it opens") {
  for (const bool with_force : {false, true}) {
    CAPTURE(with_force);
    BoardRig rig;
    if (with_force)
      rig.make_active();
    else
      rig.run_until([](const auto& pose) { return pose.state == State::ready; });
    rig.take_to(free_point_m);
    rig.control.inject({.fault = "wire_low", .of = "inkwell_switch"});
    check_reported(rig, Fault::inkwell_implausible);
    clear(rig);
    CHECK(rig.pose().state == State::unreferenced);
    rig.run(0.5);
    CHECK(rig.pose().state == State::unreferenced);
    rig.control.heal("wire_low", "inkwell_switch");
    rig.run(0.05);
    put_into_inkwell(rig);
  }
}

TEST_CASE("an inkwell switch wire at ground from the start on raises a fault when the arm leaves the inkwell") {
  BoardRig rig;
  rig.control.inject({.fault = "wire_low", .of = "inkwell_switch"});
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.take_to(free_point_m);
  check_reported(rig, Fault::inkwell_implausible);
}
