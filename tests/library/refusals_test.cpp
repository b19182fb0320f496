// Tests unusable devices and refused requests.
#include <doctest/doctest.h>

#include <inkwell/inkwell.h>
#include "tests/dropins/board.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

TEST_CASE("an unreferenced arm outputs no force before it was in the inkwell") {
  Board board({.paused = true});
  VirtualArm virtual_arm(board.address);
  virtual_arm.wait_until([](const auto& pose) { return pose.state == INKWELL_UNREFERENCED; });
  CHECK(inkwell_enable_force(virtual_arm.arm, 0.1) == INKWELL_REFUSED);
  CHECK(says("Put the stylus into the inkwell"));
  int is_referenced = 1;
  REQUIRE(inkwell_is_referenced(virtual_arm.arm, &is_referenced) == INKWELL_OK);
  CHECK(is_referenced == 0);
  board.control.dock(true);
  virtual_arm.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  REQUIRE(inkwell_is_referenced(virtual_arm.arm, &is_referenced) == INKWELL_OK);
  CHECK(is_referenced == 1);
}

TEST_CASE("a fault with a persistent cause cannot be cleared, and the error names the cause") {
  Board board;
  VirtualArm virtual_arm(board.address);
  virtual_arm.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  CHECK(inkwell_clear_fault(virtual_arm.arm) == INKWELL_OK);  // there is no fault
  board.control.inject({"bridge_fault"});
  virtual_arm.wait_until([](const auto& pose) { return pose.state == INKWELL_FAULT; });
  CHECK(inkwell_clear_fault(virtual_arm.arm) == INKWELL_REFUSED);
  CHECK(says("The board has raised the fault again. bridge_fault: A bridge reported"));
  board.control.heal("bridge_fault");
  CHECK(inkwell_clear_fault(virtual_arm.arm) == INKWELL_OK);
  inkwell_pose pose;
  REQUIRE(inkwell_get_pose(virtual_arm.arm, &pose) == INKWELL_OK);
  CHECK(pose.state == INKWELL_READY);
}

TEST_CASE("an arm with another protocol version is not opened, and the error contains the versions") {
  Board board(next_protocol);
  inkwell_arm* arm = nullptr;
  CHECK(inkwell_open(board.address.c_str(), &arm) == INKWELL_INCOMPATIBLE);
  CHECK(says("uses protocol version"));
  CHECK(arm == nullptr);
}

TEST_CASE("if more forces are sent than USB can transfer, the newest force is sent, and no force is refused or lost") {
  VirtualArm virtual_arm;
  virtual_arm.make_active();
  inkwell_information before, after;
  inkwell_pose pose;
  REQUIRE(inkwell_get_information(virtual_arm.arm, &before) == INKWELL_OK);
  REQUIRE(inkwell_wait_for_pose(virtual_arm.arm, 10.0, &pose) == INKWELL_OK);
  const auto first = pose.sequence;
  int forces = 0;
  // Ten forces per pose.
  virtual_arm.wait_until([&](const auto& now) {
    for (const double each_N : {-3., -3., -3., -3., -3., -3., -3., -3., -3., 1.}) {
      const double force_N[3]{each_N, 0, 0};
      REQUIRE(inkwell_set_force(virtual_arm.arm, force_N) == INKWELL_OK);
      ++forces;
    }
    pose = now;
    return forces > 3000;
  });
  REQUIRE(inkwell_get_information(virtual_arm.arm, &after) == INKWELL_OK);
  CHECK(after.force_reports - before.force_reports > 0);
  REQUIRE(inkwell_wait_for_pose(virtual_arm.arm, 10.0, &pose) == INKWELL_OK);
  CHECK(after.force_reports - before.force_reports <= pose.sequence - first + 2);
  CHECK(after.force_reports_refused == before.force_reports_refused);
  CHECK(after.force_reports_lost == before.force_reports_lost);
}

}  // namespace
}  // namespace inkwell::tests
