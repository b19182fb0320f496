// Tests the calls of the C++ wrapper for states, torques, parameters, samples, recordings and the simulated hand.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include <inkwell/inkwell.hpp>
#include "tests/dropins/board.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

inkwell_result failure_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Failure& failure) {
    return failure.result;
  }
  return INKWELL_OK;
}

TEST_CASE("the header has the version of the library, and its macros can be compared") {
  CHECK(std::to_string(INKWELL_VERSION_MAJOR) + "." + std::to_string(INKWELL_VERSION_MINOR) + "." +
            std::to_string(INKWELL_VERSION_PATCH) ==
        inkwell_version());
#if INKWELL_VERSION_NUMBER < 200 || INKWELL_VERSION_NUMBER / 100 != INKWELL_VERSION_MAJOR * 100 + INKWELL_VERSION_MINOR
#error "the number is wrong"
#endif
}

TEST_CASE("a successful call leaves the text of the last error, as with errno") {
  inkwell_address_kind kind;
  REQUIRE(inkwell_kind_of_address("usbip:nowhere", &kind) == INKWELL_BAD_ARGUMENT);
  const std::string text = inkwell_error_text();
  REQUIRE(inkwell_kind_of_address("virtual", &kind) == INKWELL_OK);
  CHECK(inkwell_error_text() == text);
}

TEST_CASE("C++: states, abilities, kinematics, claims and torques") {
  Board board;
  Arm arm(board.address, 60.0), other(board.address);
  const State state = arm.state();
  CHECK(state.is_referenced == 1);
  const Kinematics kinematics =
      arm.forward_kinematics({state.pose.joint_rad[0], state.pose.joint_rad[1], state.pose.joint_rad[2]});
  CHECK(kinematics.position_m[2] == doctest::Approx(state.pose.position_m[2]).epsilon(1e-4));
  CHECK(kinematics.jacobian[0] != 0.0);
  CHECK(arm.abilities().force_N > 1);
  const Vector pose_rad{0, 0.5, 0.5};
  const auto& j = arm.forward_kinematics(pose_rad).jacobian;
  const Vector force_N = arm.force_of_torques(pose_rad, {j[0], j[1], j[2]});  // torques of 1 N along x
  CHECK(force_N[0] == doctest::Approx(1.0).epsilon(1e-4));

  arm.claim();
  CHECK(failure_of([&] { other.claim(); }) == INKWELL_IN_USE);
  CHECK(failure_of([&] { other.set_joint_torques({}); }) == INKWELL_IN_USE);
  arm.release();
  CHECK_NOTHROW(other.claim());
  CHECK(failure_of([&] { arm.set_thread_priority(-1); }) == INKWELL_BAD_ARGUMENT);
  CHECK(failure_of([&] { Arm("0123456789AB", 1.0); }) == INKWELL_NO_DEVICE);

  auto known = devices();
  CHECK_FALSE(wait_for_devices(known, 0));
  known.clear();
  CHECK(wait_for_devices(known, 0));
  CHECK(known.back().address == board.address);
  CHECK(kind_of_address("virtual") == INKWELL_OWN_BOARD);
  CHECK(names().empty());
  CHECK(fault_name(INKWELL_FAULT_OVER_SPEED) == "over_speed");
  CHECK(fault_name(-1).empty());
  CHECK(fault_text(INKWELL_FAULT_OVER_SPEED).size() > 10);
}

TEST_CASE("C++: several parameters, samples, recordings and the simulated hand") {
  const TemporaryDirectory directory;
  Arm arm("virtual");
  arm.set_parameters({{"wall_stiffness_N_per_m", 500}, {"wall_damping_Ns_per_m", 1.5}});
  CHECK(arm.parameter("wall_damping_Ns_per_m") == 1.5);
  CHECK(failure_of([&] {
          arm.set_parameters({{"wall_stiffness_N_per_m", 600}, {"wall_damping_Ns_per_m", -1}});
        }) != INKWELL_OK);
  CHECK(arm.parameter("wall_stiffness_N_per_m") == 500);

  arm.move_virtual_hand({0.02, 0, -0.03});
  while (arm.pose().position_m[0] < 0.015) arm.wait_for_pose();
  arm.press_virtual_buttons(true, false);
  while (arm.pose().button_1 == 0) arm.wait_for_pose();
  CHECK(arm.pose().button_2 == 0);

  CHECK(failure_of([&] { arm.read_scope(); }) == INKWELL_REFUSED);
  arm.select_signals({"position_x_m", "supply_V"});
  const Samples samples = arm.read_scope(100, 10.0);
  REQUIRE(!samples.periods.empty());
  CHECK(samples.periods.size() <= 100);
  CHECK(samples.values.size() == 2 * samples.periods.size());
  CHECK(samples.values[0] == doctest::Approx(0.02).epsilon(0.1));
  CHECK(samples.values[1] == doctest::Approx(18).epsilon(0.1));
  const std::string file = directory.file("wrapper.csv");
  arm.start_recording(file);
  arm.sleep(0.05);
  CHECK(arm.stop_recording().samples > 500);
  CHECK(std::filesystem::file_size(file) > 1000);
  arm.select_signals({});
  arm.release_virtual_hand();

  Arm moved = std::move(arm);
  // NOLINTBEGIN(bugprone-use-after-move): this test uses a moved arm
  CHECK(failure_of([&] { arm.read_scope(); }) == INKWELL_BAD_ARGUMENT);
  CHECK(failure_of([&] { arm.select_signals({"supply_V"}); }) == INKWELL_BAD_ARGUMENT);
  CHECK(failure_of([&] { arm.state(); }) == INKWELL_BAD_ARGUMENT);
  // NOLINTEND(bugprone-use-after-move)
}

}  // namespace
}  // namespace inkwell::tests
