#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <inkwell/inkwell.h>
#include "protocol/self_test.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/library/virtual_arm.hpp"

namespace {

using inkwell::tests::TemporaryDirectory;
using inkwell::tests::VirtualArm, inkwell::tests::free_point_m, inkwell::tests::hand_N_per_m, inkwell::tests::says;

TEST_CASE("the C interface reports the information and the pose of an arm") {
  VirtualArm virtual_arm;
  inkwell_information information;
  REQUIRE(inkwell_get_information(virtual_arm.arm, &information) == INKWELL_OK);
  CHECK(information.is_virtual == 1);
  CHECK(std::string(information.serial_number).size() == 24);
  CHECK(std::string(information.product) == "Inkwell haptic arm");
  CHECK(std::string(information.firmware_version) == inkwell_version());
  CHECK(information.servo_rate_Hz == 20'000);
  char board[INKWELL_BOARD_NAME_SIZE];
  REQUIRE(inkwell_get_board_name(virtual_arm.arm, board) == INKWELL_OK);
  CHECK(std::string(board) == "omni_driver");
  CHECK(inkwell_get_board_name(virtual_arm.arm, nullptr) == INKWELL_BAD_ARGUMENT);

  const auto pose = virtual_arm.wait_until([](const auto& now) { return now.state == INKWELL_READY; });
  CHECK(pose.in_inkwell == 1);
  int is_referenced = 0;
  REQUIRE(inkwell_is_referenced(virtual_arm.arm, &is_referenced) == INKWELL_OK);
  CHECK(is_referenced == 1);
  CHECK(inkwell_is_referenced(virtual_arm.arm, nullptr) == INKWELL_BAD_ARGUMENT);
  CHECK(pose.supply_V == doctest::Approx(18.0).epsilon(0.05));
  for (int row = 0; row < 3; ++row)
    for (int other = 0; other < 3; ++other) {
      double product = 0;
      for (int i = 0; i < 3; ++i) product += pose.rotation[3 * row + i] * pose.rotation[3 * other + i];
      CHECK(product == doctest::Approx(row == other ? 1.0 : 0.0).epsilon(1e-5));
    }
  REQUIRE(inkwell_press_virtual_buttons(virtual_arm.arm, 0, 1) == INKWELL_OK);
  CHECK(virtual_arm.wait_until([](const auto& now) { return now.button_2 == 1; }).button_1 == 0);
}

TEST_CASE("poses come one after the other, and the velocity is that of the probe") {
  VirtualArm virtual_arm;
  virtual_arm.hold_in_the_open();
  const double beside_m[3]{0.03, 0.0, -0.03};
  REQUIRE(inkwell_move_virtual_hand(virtual_arm.arm, beside_m, hand_N_per_m) == INKWELL_OK);
  inkwell_pose before, pose;
  REQUIRE(inkwell_wait_for_pose(virtual_arm.arm, 10.0, &before) == INKWELL_OK);
  const inkwell_pose first = before;
  double travelled_m = 0;
  for (int i = 0; i < 300; ++i) {
    REQUIRE(inkwell_wait_for_pose(virtual_arm.arm, 10.0, &pose) == INKWELL_OK);
    CHECK(pose.sequence > before.sequence);
    travelled_m += pose.velocity_m_s[0] * (pose.time_s - before.time_s);
    before = pose;
  }
  CHECK(pose.position_m[0] - first.position_m[0] > 0.015);
  CHECK(travelled_m == doctest::Approx(pose.position_m[0] - first.position_m[0]).scale(0).epsilon(0.1));
}

TEST_CASE("parameters are stored, restored and forgotten, but not while the force is on") {
  VirtualArm virtual_arm;
  inkwell_arm* arm = virtual_arm.arm;
  const char* const name = "link_2_m";  // the library itself uses this parameter
  const auto set = [&](double value_m) { REQUIRE(inkwell_set_parameters(arm, &name, &value_m, 1) == INKWELL_OK); };
  const auto held_m = [&] {
    double value_m = 0;
    REQUIRE(inkwell_get_parameter(arm, name, &value_m) == INKWELL_OK);
    return value_m;
  };
  const auto stored_m = [&] {
    double value_m = 0;
    REQUIRE(inkwell_get_stored_parameter(arm, name, &value_m) == INKWELL_OK);
    return value_m;
  };
  const auto store = [&] {
    inkwell_store store_state;
    REQUIRE(inkwell_get_store(arm, &store_state) == INKWELL_OK);
    return store_state;
  };
  const auto reach_m = [&] {
    const double joint_rad[3]{};
    double position_m[3];
    REQUIRE(inkwell_forward_kinematics(arm, joint_rad, position_m, nullptr) == INKWELL_OK);
    return std::array{position_m[0], position_m[1], position_m[2]};
  };
  const double default_m = held_m();
  const auto default_reach_m = reach_m();
  CHECK(inkwell_restore_parameters(arm) == INKWELL_REFUSED);
  CHECK(says("no stored parameters"));
  CHECK(store().contents == INKWELL_STORED_NOTHING);
  set(default_m + 0.01);
  const auto longer_reach_m = reach_m();
  CHECK(store().not_stored == 1);
  CHECK(stored_m() == default_m);
  REQUIRE(inkwell_store_parameters(arm) == INKWELL_OK);
  CHECK(store().contents == INKWELL_STORED_PARAMETERS);
  CHECK(store().not_stored == 0);
  CHECK(store().records_written == 1);
  CHECK(store().stores_left > 0);
  CHECK(stored_m() == doctest::Approx(default_m + 0.01));
  set(default_m + 0.02);
  REQUIRE(inkwell_restore_parameters(arm) == INKWELL_OK);
  CHECK(held_m() == doctest::Approx(default_m + 0.01));
  CHECK(reach_m() == longer_reach_m);
  REQUIRE(inkwell_factory_reset(arm) == INKWELL_OK);
  CHECK(held_m() == default_m);
  CHECK(reach_m() == default_reach_m);
  CHECK(store().contents == INKWELL_STORED_FACTORY_RESET);

  virtual_arm.make_active();
  CHECK(inkwell_store_parameters(arm) == INKWELL_REFUSED);
  CHECK(says("Switch the force off"));
  CHECK(inkwell_factory_reset(arm) == INKWELL_REFUSED);
}

TEST_CASE("the board tests itself: items with figures, kept until the next test, refused while the force is on") {
  VirtualArm virtual_arm;
  inkwell_arm* arm = virtual_arm.arm;
  std::size_t count = 0;
  REQUIRE(inkwell_get_self_test(arm, nullptr, 0, &count) == INKWELL_OK);
  CHECK(count == inkwell::protocol::self_test_item_count);
  std::vector<inkwell_test_item> items(count + 1);
  items[count].name = "untouched";
  REQUIRE(inkwell_self_test(arm, items.data(), items.size(), &count) == INKWELL_OK);
  CHECK(count == inkwell::protocol::self_test_item_count);
  CHECK(items[count].name == std::string("untouched"));
  double resistance_ohm = 0;
  REQUIRE(inkwell_get_parameter(arm, "motor_resistance_2_ohm", &resistance_ohm) == INKWELL_OK);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& item = items[i];
    CAPTURE(item.name);
    CHECK(item.result == INKWELL_TEST_PASSED);
    CHECK(std::string(item.meaning).size() > 10);
    CHECK(std::string(item.remedy).size() > 10);
    if (item.name == std::string("motor_2")) {
      CHECK(item.unit == std::string("ohm"));
      CHECK(item.figure == doctest::Approx(resistance_ohm).epsilon(0.2));
      CHECK(item.takes_force == 1);
    }
    if (item.name == std::string("bridge_2")) CHECK(item.takes_force == 0);
  }
  std::vector<inkwell_test_item> few(2);
  few[1].name = "untouched";
  REQUIRE(inkwell_get_self_test(arm, few.data(), 1, &count) == INKWELL_OK);
  CHECK(few[0].name == std::string("flash"));
  CHECK(few[1].name == std::string("untouched"));
  CHECK(inkwell_self_test(arm, nullptr, 3, &count) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_self_test(arm, few.data(), 1, nullptr) == INKWELL_BAD_ARGUMENT);

  virtual_arm.make_active();
  CHECK(inkwell_self_test(arm, items.data(), items.size(), &count) == INKWELL_REFUSED);
  CHECK(says("Switch the force off"));
  CHECK(inkwell_get_self_test(arm, items.data(), items.size(), &count) == INKWELL_OK);
}

TEST_CASE("forward kinematics: the pose's own position, and a Jacobian that agrees with it") {
  VirtualArm virtual_arm;
  const auto pose = virtual_arm.wait_until([](const auto& now) { return now.state == INKWELL_READY; });
  double position_m[3], jacobian[9];
  REQUIRE(inkwell_forward_kinematics(virtual_arm.arm, pose.joint_rad, position_m, jacobian) == INKWELL_OK);
  for (int i = 0; i < 3; ++i) CHECK(position_m[i] == doctest::Approx(pose.position_m[i]).epsilon(1e-4));
  for (int joint = 0; joint < 3; ++joint) {
    constexpr double step_rad = 0.01;
    double beside_rad[3]{pose.joint_rad[0], pose.joint_rad[1], pose.joint_rad[2]}, beside_m[3];
    beside_rad[joint] += step_rad;
    REQUIRE(inkwell_forward_kinematics(virtual_arm.arm, beside_rad, beside_m, nullptr) == INKWELL_OK);
    for (int axis = 0; axis < 3; ++axis) {
      const double slope_m_per_rad = (beside_m[axis] - position_m[axis]) / step_rad;
      CHECK(std::abs(jacobian[3 * axis + joint] - slope_m_per_rad) < 0.002);
    }
  }
  const double none_rad[3]{std::numeric_limits<double>::infinity(), 0, 0};
  CHECK(inkwell_forward_kinematics(virtual_arm.arm, none_rad, position_m, jacobian) == INKWELL_BAD_ARGUMENT);
}

TEST_CASE("an arm of other lengths: its firmware knows them") {
  const TemporaryDirectory directory;
  const auto file = directory.file("long.toml");
  {
    std::ifstream omni(INKWELL_SOURCE_DIRECTORY "/boards/arms/omni.toml");
    std::ofstream changed(file);
    for (std::string line; std::getline(omni, line);)
      changed << (line.starts_with("link_3_m ") ? "link_3_m = 0.16" : line) << '\n';
  }
  VirtualArm virtual_arm("virtual:" + file);
  double length_m = 0;
  REQUIRE(inkwell_get_parameter(virtual_arm.arm, "link_3_m", &length_m) == INKWELL_OK);
  CHECK(length_m == doctest::Approx(0.16));
  constexpr double stiff_N_per_m = 2000;  // deflected by gravity by less than 1 mm
  REQUIRE(inkwell_move_virtual_hand(virtual_arm.arm, free_point_m, stiff_N_per_m) == INKWELL_OK);
  virtual_arm.wait_until([](const auto& pose) {
    return std::hypot(pose.position_m[0] - free_point_m[0], pose.position_m[1] - free_point_m[1],
                      pose.position_m[2] - free_point_m[2]) < 0.002;
  });
}

struct Spring {
  double stiffness_N_per_m = 100;
  std::atomic<int> calls = 0;
};

int spring(inkwell_arm*, const inkwell_pose* pose, double force_N[3], void* user) {
  auto& self = *static_cast<Spring*>(user);
  ++self.calls;
  for (int i = 0; i < 3; ++i)
    force_N[i] = -self.stiffness_N_per_m * (pose->position_m[i] - (i == 0 ? 0.02 : free_point_m[i]));
  return 0;
}

TEST_CASE("a servo pulls the hand, and lets go when it is stopped") {
  VirtualArm virtual_arm;
  virtual_arm.make_active();
  Spring user;
  REQUIRE(inkwell_start_servo(virtual_arm.arm, spring, &user) == INKWELL_OK);
  CHECK(inkwell_servo_is_running(virtual_arm.arm) == 1);
  CHECK(inkwell_start_servo(virtual_arm.arm, spring, &user) == INKWELL_REFUSED);
  // The springs of 300 and 100 N/m have rest positions 20 mm apart.
  const auto pulled = virtual_arm.wait_until([](const auto& pose) {
    return std::abs(pose.position_m[0] - 0.005) < 0.0007 && std::abs(pose.velocity_m_s[0]) < 0.005;
  });
  CHECK(pulled.force_N[0] == doctest::Approx(1.5).epsilon(0.1));
  CHECK((pulled.force_sources & INKWELL_PROGRAM) != 0);
  CHECK((pulled.force_sources & INKWELL_WALLS) == 0);
  CHECK(pulled.limits == 0);
  REQUIRE(inkwell_stop_servo(virtual_arm.arm) == INKWELL_OK);
  CHECK(inkwell_servo_is_running(virtual_arm.arm) == 0);
  const int calls = user.calls;
  CHECK(calls > 20);
  virtual_arm.wait_until(
      [](const auto& pose) { return (pose.force_sources & INKWELL_PROGRAM) == 0 && pose.force_N[0] == 0.0; });
  CHECK(user.calls == calls);
  inkwell_information information;
  REQUIRE(inkwell_get_information(virtual_arm.arm, &information) == INKWELL_OK);
  CHECK(information.force_reports > 20);
  CHECK(information.force_reports_refused == 0);
}

TEST_CASE("a servo may end itself, answer with no number, or be closed under way") {
  VirtualArm virtual_arm;
  virtual_arm.make_active();
  std::atomic<int> calls = 0;
  const auto ends = [](inkwell_arm* arm, const inkwell_pose*, double force_N[3], void* user) {
    force_N[0] = std::numeric_limits<double>::quiet_NaN();
    auto& count = *static_cast<std::atomic<int>*>(user);
    if (++count == 5) inkwell_stop_servo(arm);
    return count < 5 ? 0 : 1;
  };
  REQUIRE(inkwell_start_servo(virtual_arm.arm, ends, &calls) == INKWELL_OK);
  virtual_arm.wait_until([&](const auto&) { return inkwell_servo_is_running(virtual_arm.arm) == 0; });
  CHECK(calls == 5);
  calls = 1000;
  const auto goes_on = [](inkwell_arm*, const inkwell_pose*, double*, void* user) {
    ++*static_cast<std::atomic<int>*>(user);
    return 0;
  };
  REQUIRE(inkwell_start_servo(virtual_arm.arm, goes_on, &calls) == INKWELL_OK);
  virtual_arm.wait_until([&](const auto&) { return calls > 1010; });
  inkwell_information information;
  REQUIRE(inkwell_get_information(virtual_arm.arm, &information) == INKWELL_OK);
  CHECK(information.force_reports_refused == 0);
}

TEST_CASE("without a servo, forces last while they are renewed, are bounded, and are refused if not finite") {
  VirtualArm virtual_arm;
  virtual_arm.make_active();
  REQUIRE(inkwell_set_force_mode(virtual_arm.arm, INKWELL_BESIDE_WALLS) == INKWELL_OK);
  const double huge_N[3]{1e300, 0, 0};
  const auto felt = virtual_arm.wait_until([&](const auto& pose) {
    REQUIRE(inkwell_set_force(virtual_arm.arm, huge_N) == INKWELL_OK);
    return std::abs(pose.force_N[0]) > 3.0;
  });
  CHECK(felt.force_N[0] < 3.31);
  CHECK(felt.force_sources == (INKWELL_PROGRAM | INKWELL_WALLS));
  virtual_arm.wait_until([](const auto& pose) { return (pose.force_sources & INKWELL_PROGRAM) == 0; });
  constexpr double infinite_N = std::numeric_limits<double>::infinity();
  for (const double wrong_N : {std::numeric_limits<double>::quiet_NaN(), infinite_N, -infinite_N}) {
    const double none_N[3]{0, wrong_N, 0};
    CHECK(inkwell_set_force(virtual_arm.arm, none_N) == INKWELL_BAD_ARGUMENT);
    CHECK(says("not a finite number"));
  }
  CHECK(inkwell_set_force_mode(virtual_arm.arm, static_cast<inkwell_force_mode>(7)) == INKWELL_BAD_ARGUMENT);
}

TEST_CASE("a limit is reported in the pose while it reduces the force") {
  VirtualArm virtual_arm;
  virtual_arm.make_active();
  const auto push_until = [&](double force_N, auto condition) {
    return virtual_arm.wait_until([&](const auto& pose) {
      const double to_the_right_N[3]{force_N, 0, 0};
      REQUIRE(inkwell_set_force(virtual_arm.arm, to_the_right_N) == INKWELL_OK);
      return condition(pose);
    });
  };
  push_until(100.0, [](const auto& pose) {
    return (pose.limits & INKWELL_LIMIT_FORCE) != 0 && std::abs(pose.force_N[0] - 3.3) < 0.01;
  });
  push_until(0.5, [](const auto& pose) { return pose.limits == 0; });
  const char* const name = "current_limit_1_A";
  const double little_A = 0.02;
  REQUIRE(inkwell_set_parameters(virtual_arm.arm, &name, &little_A, 1) == INKWELL_OK);
  push_until(0.5, [](const auto& pose) { return pose.limits == INKWELL_LIMIT_CURRENT; });
  push_until(0.0, [](const auto& pose) { return pose.limits == 0; });
}

TEST_CASE("a plane supports the probe, and an invalid set of shapes changes nothing") {
  VirtualArm virtual_arm;
  virtual_arm.make_active();
  inkwell_plane floor{{0, 0, -0.03}, {0, 0, 1}, {1000, 2, 0, 0, 10}};
  REQUIRE_MESSAGE(inkwell_place_shapes(virtual_arm.arm, &floor, 1, nullptr) == INKWELL_OK,
                  std::string(inkwell_error_text()));
  const double below_m[3]{0, 0, -0.034};
  REQUIRE(inkwell_move_virtual_hand(virtual_arm.arm, below_m, hand_N_per_m) == INKWELL_OK);
  // The springs of 300 and 1000 N/m have rest positions 4 mm apart.
  virtual_arm.wait_until([](const auto& pose) {
    return std::abs(pose.force_N[2] - 0.92) < 0.1 && (pose.force_sources & INKWELL_SHAPES) != 0;
  });
  floor.normal[2] = 0;
  CHECK(inkwell_place_shapes(virtual_arm.arm, &floor, 1, nullptr) == INKWELL_BAD_ARGUMENT);
  CHECK(says("normal of plane 0"));
  const std::vector<inkwell_plane> many(9, floor);
  CHECK(inkwell_place_shapes(virtual_arm.arm, many.data(), many.size(), nullptr) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_place_shapes(virtual_arm.arm, nullptr, 1, nullptr) == INKWELL_BAD_ARGUMENT);
  inkwell_pose pose;
  REQUIRE(inkwell_wait_for_pose(virtual_arm.arm, 10, &pose) == INKWELL_OK);
  CHECK((pose.force_sources & INKWELL_SHAPES) != 0);
  REQUIRE(inkwell_place_shapes(virtual_arm.arm, nullptr, 0, nullptr) == INKWELL_OK);
  virtual_arm.wait_until([](const auto& now) { return (now.force_sources & INKWELL_SHAPES) == 0; });
}

TEST_CASE("parameters by name: read, set together, refused whole") {
  VirtualArm virtual_arm;
  double value = 0;
  REQUIRE(inkwell_get_parameter(virtual_arm.arm, "wall_stiffness_N_per_m", &value) == INKWELL_OK);
  CHECK(value == 800);
  const char* names[]{"wall_stiffness_N_per_m", "wall_damping_Ns_per_m"};
  const double good[]{500, 1.5}, bad[]{600, 1e6};
  REQUIRE(inkwell_set_parameters(virtual_arm.arm, names, good, 2) == INKWELL_OK);
  CHECK(inkwell_set_parameters(virtual_arm.arm, names, bad, 2) == INKWELL_REFUSED);
  CHECK(says("wall_damping_Ns_per_m"));
  REQUIRE(inkwell_get_parameter(virtual_arm.arm, "wall_stiffness_N_per_m", &value) == INKWELL_OK);
  CHECK(value == 500);
  CHECK(inkwell_get_parameter(virtual_arm.arm, "wall_stifness_N_per_m", &value) == INKWELL_BAD_ARGUMENT);
  CHECK(says("Did you mean wall_stiffness_N_per_m?"));
  const std::vector<const char*> many(97, names[0]);
  const std::vector<double> many_values(97, 500.0);
  CHECK(inkwell_set_parameters(virtual_arm.arm, many.data(), many_values.data(), 97) == INKWELL_BAD_ARGUMENT);
  CHECK(says("97 parameters are too many. Give at most 96."));
  bool found = false;
  for (std::size_t i = 0; i < inkwell_parameter_count(); ++i)
    found |= std::string(inkwell_parameter_at(i)->name) == "force_limit_N" && inkwell_parameter_at(i)->maximum == 8;
  CHECK(found);
  CHECK(inkwell_parameter_at(inkwell_parameter_count()) == nullptr);
}

TEST_CASE("the scope returns every control period, and a recording contains all of them") {
  VirtualArm virtual_arm;
  std::vector<float> values(2 * 1000);
  std::vector<std::uint32_t> periods(1000);
  std::size_t count = 0;
  std::uint64_t lost = 0;
  CHECK(inkwell_read_scope(virtual_arm.arm, 0.1, values.data(), periods.data(), 1000, &count, &lost) ==
        INKWELL_REFUSED);
  const char* wrong[]{"position_x_mm"};
  CHECK(inkwell_select_signals(virtual_arm.arm, wrong, 1) == INKWELL_BAD_ARGUMENT);
  const std::vector<const char*> many(33, "supply_V");
  CHECK(inkwell_select_signals(virtual_arm.arm, many.data(), many.size()) == INKWELL_BAD_ARGUMENT);
  CHECK(says("contain a signal twice. Give each signal once, or at most 32 signals."));
  const std::vector<const char*> too_many(65, "supply_V");
  CHECK(inkwell_select_signals(virtual_arm.arm, too_many.data(), too_many.size()) == INKWELL_BAD_ARGUMENT);
  const char* names[]{"position_z_m", "supply_V"};
  REQUIRE_MESSAGE(inkwell_select_signals(virtual_arm.arm, names, 2) == INKWELL_OK, std::string(inkwell_error_text()));
  std::uint32_t next = 0;
  for (std::size_t rows = 0; rows < 5000; rows += count) {
    REQUIRE(inkwell_read_scope(virtual_arm.arm, 10, values.data(), periods.data(), 37, &count, &lost) == INKWELL_OK);
    REQUIRE(count > 0);
    REQUIRE(count <= 37);
    for (std::size_t i = 0; i < count; ++i) {
      if (rows + i > 0) REQUIRE(periods[i] == next + (i == 0 ? lost : 0));
      next = periods[i] + 1;
      CHECK(values[2 * i + 1] == doctest::Approx(18.0).epsilon(0.05));
    }
  }
  const TemporaryDirectory directory;
  const auto file = directory.file("arm.csv");
  REQUIRE_MESSAGE(inkwell_start_recording(virtual_arm.arm, file.c_str()) == INKWELL_OK,
                  std::string(inkwell_error_text()));
  CHECK(inkwell_start_recording(virtual_arm.arm, file.c_str()) == INKWELL_REFUSED);
  inkwell_pose pose;
  for (int i = 0; i < 100; ++i) REQUIRE(inkwell_wait_for_pose(virtual_arm.arm, 10, &pose) == INKWELL_OK);
  std::uint64_t samples = 0;
  REQUIRE_MESSAGE(inkwell_stop_recording(virtual_arm.arm, &samples, &lost) == INKWELL_OK,
                  std::string(inkwell_error_text()));
  CHECK(samples > 1000);
  CHECK(lost == 0);
  std::ifstream text(file);
  std::string line, all;
  while (std::getline(text, line)) all += line + '\n';
  CHECK(all.find("position_z_m") != std::string::npos);
  CHECK(inkwell_stop_recording(virtual_arm.arm, nullptr, nullptr) == INKWELL_REFUSED);
}

TEST_CASE("two arms at once") {
  VirtualArm left, right;
  inkwell_information one, other;
  REQUIRE(inkwell_get_information(left.arm, &one) == INKWELL_OK);
  REQUIRE(inkwell_get_information(right.arm, &other) == INKWELL_OK);
  CHECK(std::string(one.serial_number) != other.serial_number);
  const double force_N[3]{};
  CHECK(inkwell_set_force(left.arm, force_N) == INKWELL_OK);
  CHECK_MESSAGE(inkwell_set_force(right.arm, force_N) == INKWELL_OK, std::string(inkwell_error_text()));
}

TEST_CASE("each invalid call returns an error code with a sentence and leaves its outputs unchanged") {
  inkwell_arm* arm = nullptr;
  CHECK(inkwell_open("usbip:nowhere", &arm) == INKWELL_BAD_ARGUMENT);
  CHECK(says("127.0.0.1:3240"));
  CHECK(inkwell_open("usbip:127.0.0.1:1", &arm) == INKWELL_FAILED);
  CHECK(inkwell_open("0123456789AB", &arm) == INKWELL_NO_DEVICE);
  CHECK(says("0123456789AB"));
  CHECK(inkwell_open("no such number", &arm) == INKWELL_BAD_ARGUMENT);
  CHECK(says("no such number"));
  CHECK(inkwell_open("virtual:/no/such/arm.toml", &arm) == INKWELL_FAILED);
  CHECK(says("/no/such/arm.toml"));
  CHECK(inkwell_open("virtual", nullptr) == INKWELL_BAD_ARGUMENT);
  CHECK(arm == nullptr);
  inkwell_pose pose;
  CHECK(inkwell_get_pose(nullptr, &pose) == INKWELL_BAD_ARGUMENT);
  CHECK(says("The arm is NULL"));
  CHECK(inkwell_list_devices(nullptr, 3, nullptr) == INKWELL_BAD_ARGUMENT);
  inkwell_address_kind kind;
  CHECK(inkwell_kind_of_address("virtual:arm.toml", &kind) == INKWELL_OK);
  CHECK(kind == INKWELL_OWN_BOARD);
  CHECK(inkwell_kind_of_address("usbip:localhost:3240", &kind) == INKWELL_OK);
  CHECK(kind == INKWELL_AT_SERVER);
  CHECK(inkwell_kind_of_address("Left", &kind) == INKWELL_OK);
  CHECK(kind == INKWELL_ON_USB);
  CHECK(inkwell_kind_of_address("usbip:nowhere", &kind) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_kind_of_address(nullptr, &kind) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_servo_is_running(nullptr) == 0);
  inkwell_close(nullptr);
  CHECK(std::string(inkwell_fault_name(INKWELL_FAULT_OVER_SPEED)) == "over_speed");
  CHECK(inkwell_fault_name(-1) == nullptr);
  CHECK(std::string(inkwell_fault_text(INKWELL_FAULT_OVER_CURRENT)).find("motor current") != std::string::npos);
  CHECK(std::string(inkwell_fault_text(-1)).size() > 10);

  VirtualArm virtual_arm;
  CHECK(inkwell_get_pose(virtual_arm.arm, nullptr) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_set_force(virtual_arm.arm, nullptr) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_start_servo(virtual_arm.arm, nullptr, nullptr) == INKWELL_BAD_ARGUMENT);
}

}  // namespace
