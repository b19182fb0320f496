// Tests the combined force of walls, shapes and a program in the controller.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace {

using namespace inkwell;
using control::Vector3;
using protocol::ForceMode;
using protocol::ForceSource;
using protocol::Parameter;
using protocol::Signal;

constexpr float wall_depth_m = 0.001f;

/// The inkwell is 1 mm deep in the lower z wall and far from the other walls. The walls have no damping.
protocol::ParameterSet parameters_in_wall() {
  protocol::ParameterSet set = tests::without_motors(tests::omni_parameters());
  const control::Settings settings = control::prepare(set);
  const float z_m = control::forward_kinematics(settings.encoders.inkwell_rad, settings.arm).position_m.z;
  set[Parameter::box_minimum_x_m] = set[Parameter::box_minimum_y_m] = -0.5f;
  set[Parameter::box_maximum_x_m] = set[Parameter::box_maximum_y_m] = set[Parameter::box_maximum_z_m] = 0.5f;
  set[Parameter::sphere_radius_m] = 0.0f;
  set[Parameter::box_minimum_z_m] = z_m + wall_depth_m;
  set[Parameter::wall_stiffness_N_per_m] = 1000.0f;
  return set;
}

/// A board with a stationary arm at full force.
struct StillArm {
  protocol::ParameterSet parameters = parameters_in_wall();
  control::Settings settings = control::prepare(parameters);
  control::Controller controller = tests::active_controller(settings);
  Vector3 probe_m;

  StillArm() {
    run(6'000);
    const auto signals = controller.signals();
    probe_m = {signals[Signal::position_x_m], signals[Signal::position_y_m], signals[Signal::position_z_m]};
  }

  void run(std::uint32_t periods) {
    for (std::uint32_t i = 0; i < periods; ++i) {
      controller.host_alive();
      tests::run(controller, tests::samples_at_rest(), settings, 1);
    }
  }

  void change(Parameter parameter, float value) {
    parameters[parameter] = value;
    settings = control::prepare(parameters);
    controller.settings_changed();
  }

  Vector3 force_N() const {
    const auto signals = controller.signals();
    return {signals[Signal::force_x_N], signals[Signal::force_y_N], signals[Signal::force_z_N]};
  }

  /// Returns the largest change of the force within one millisecond.
  float largest_step_N(std::uint32_t milliseconds) {
    float largest_N = 0.0f;
    for (std::uint32_t i = 0; i < milliseconds; ++i) {
      const Vector3 before_N = force_N();
      run(20);
      const Vector3 change_N = force_N() - before_N;
      largest_N = std::max(largest_N, std::sqrt(control::dot(change_N, change_N)));
    }
    return largest_N;
  }

  void drive(const Vector3& force_N, ForceMode mode) { controller.drive({force_N, mode, 20, 0.05f}, settings); }

  control::Shapes floor(float depth_m) const {
    control::Shapes shapes;
    shapes.planes[0] = {{0.0f, 0.0f, 1.0f}, probe_m.z + depth_m};
    shapes.surfaces[0] = {1000.0f, 1e-3f, 0.0f, 0.0f, 0.0f, 0.0f};
    shapes.life_periods[0] = 100'000;
    find_tangents(shapes, probe_m);
    return shapes;
  }
};

constexpr std::uint8_t bit(ForceSource source) { return static_cast<std::uint8_t>(source); }

TEST_CASE("a program's force adds to the walls") {
  StillArm arm;
  CHECK(arm.controller.force_sources() == bit(ForceSource::walls));
  CHECK(arm.force_N().z == doctest::Approx(1.0f).epsilon(1e-3));
  arm.drive({0.5f, 0.0f, 0.25f}, ForceMode::beside_walls);
  arm.run(100);
  CHECK(arm.force_N().x == doctest::Approx(0.5f).epsilon(1e-3));
  CHECK(arm.force_N().z == doctest::Approx(1.25f).epsilon(1e-3));
  CHECK(arm.controller.force_sources() == (bit(ForceSource::walls) | bit(ForceSource::program)));
  const auto signals = arm.controller.signals();
  CHECK(signals[Signal::program_force_x_N] == doctest::Approx(0.5f).epsilon(1e-4));
  CHECK(signals[Signal::program_force_z_N] == doctest::Approx(0.25f).epsilon(1e-4));
  CHECK(signals[Signal::force_sources] == 5.0f);
}

TEST_CASE("no force source is reported from the period in which the force switches off") {
  StillArm arm;
  control::Shapes shapes = arm.floor(0.001f);
  arm.controller.replace_shapes(shapes);
  arm.drive({0.5f, 0.0f, 0.0f}, ForceMode::beside_walls);
  arm.run(20);
  const auto all = bit(ForceSource::walls) | bit(ForceSource::shapes) | bit(ForceSource::program);
  CHECK(arm.controller.force_sources() == all);
  arm.controller.carry_out({.command = protocol::Command::stop});
  for (int i = 0; i < 20; ++i) {
    arm.drive({0.5f, 0.0f, 0.0f}, ForceMode::beside_walls);
    arm.run(1);
    CHECK(arm.controller.state() == protocol::State::ready);
    CHECK(arm.controller.force_sources() == 0);
    CHECK(arm.controller.signals()[Signal::force_sources] == 0.0f);
  }
  arm.controller.carry_out({.command = protocol::Command::enable_force});
  arm.run(2);
  CHECK(arm.controller.force_sources() == all);
}

TEST_CASE("a program that replaces the walls, and returns to them, is felt without a jump") {
  StillArm arm;
  arm.drive({}, ForceMode::instead_of_walls);
  const float limit_N = 0.05f * arm.settings.force_limit_N;
  CHECK(arm.largest_step_N(40) <= limit_N);
  CHECK(arm.force_N().z == doctest::Approx(0.0f).epsilon(1e-6));
  CHECK(arm.controller.force_sources() == bit(ForceSource::program));
  arm.drive({}, ForceMode::beside_walls);
  CHECK(arm.largest_step_N(40) <= limit_N);
  CHECK(arm.force_N().z == doctest::Approx(1.0f).epsilon(1e-3));
  arm.drive({}, ForceMode::instead_of_walls);
  arm.run(800);
  // The program stops sending. The program's force expires, and the wall force remains.
  CHECK(arm.largest_step_N(100) <= limit_N);
  CHECK(arm.force_N().z == doctest::Approx(1.0f).epsilon(1e-3));
  CHECK(arm.controller.force_sources() == bit(ForceSource::walls));
}

TEST_CASE("a plane that appears, moves by 5 mm or disappears under a pressing hand causes no kick") {
  StillArm arm;
  const float limit_N = 0.05f * arm.settings.force_limit_N;
  arm.drive({}, ForceMode::instead_of_walls);
  arm.run(800);
  control::Shapes shapes[2] = {arm.floor(0.001f), {}};
  arm.controller.replace_shapes(shapes[0]);
  arm.drive({}, ForceMode::instead_of_walls);
  CHECK(arm.largest_step_N(40) <= limit_N);
  CHECK(arm.controller.force_sources() == (bit(ForceSource::shapes) | bit(ForceSource::program)));
  arm.drive({}, ForceMode::instead_of_walls);
  arm.run(800);
  CHECK(arm.force_N().z == doctest::Approx(1.0f).epsilon(1e-3));

  const control::Shapes moves[] = {arm.floor(0.003f), arm.floor(-0.002f), arm.floor(0.0025f), arm.floor(0.0f), {}};
  std::size_t index = 1;
  for (const control::Shapes& moved : moves) {
    arm.drive({}, ForceMode::instead_of_walls);
    shapes[index] = moved;
    arm.controller.replace_shapes(shapes[index]);
    index ^= 1u;
    CHECK(arm.largest_step_N(40) <= limit_N);
    const float depth_m = moved.life_periods[0] == 0 ? 0.0f : moved.planes[0].offset_m - arm.probe_m.z;
    CHECK(arm.force_N().z == doctest::Approx(std::max(0.0f, 1000.0f * depth_m)).epsilon(2e-3));
  }
}

TEST_CASE("a shape whose life ends under a pressing hand releases the hand slowly") {
  StillArm arm;
  arm.drive({}, ForceMode::instead_of_walls);
  arm.run(800);
  control::Shapes shapes = arm.floor(0.002f);
  shapes.life_periods[0] = 1'000;
  arm.controller.replace_shapes(shapes);
  arm.drive({}, ForceMode::instead_of_walls);
  arm.run(975);
  CHECK(arm.force_N().z == doctest::Approx(2.0f).epsilon(2e-3));
  arm.drive({}, ForceMode::instead_of_walls);
  CHECK(arm.largest_step_N(40) <= 0.05f * arm.settings.force_limit_N);
  CHECK(arm.force_N().z == doctest::Approx(0.0f).epsilon(1e-6));
}

TEST_CASE("parameters that change under a pressing hand never kick") {
  StillArm arm;
  const float limit_N = 0.05f * arm.settings.force_limit_N;
  const float floor_m = arm.parameters[Parameter::box_minimum_z_m];
  arm.change(Parameter::box_minimum_z_m, floor_m + 0.002f);
  CHECK(arm.largest_step_N(40) <= limit_N);
  CHECK(arm.force_N().z == doctest::Approx(3.0f).epsilon(2e-3));
  arm.change(Parameter::box_minimum_z_m, floor_m - 0.0005f);
  CHECK(arm.largest_step_N(40) <= limit_N);
  CHECK(arm.force_N().z == doctest::Approx(0.5f).epsilon(2e-3));
  arm.change(Parameter::wall_stiffness_N_per_m, 3000.0f);
  CHECK(arm.largest_step_N(40) <= limit_N);
  CHECK(arm.force_N().z == doctest::Approx(1.5f).epsilon(2e-3));
}

TEST_CASE("a raised force limit increases the force without a kick, and a lowered limit applies immediately") {
  StillArm arm;
  arm.change(Parameter::force_limit_N, 0.0f);
  arm.run(1);
  CHECK(arm.force_N().z == 0.0f);
  arm.run(40);
  arm.change(Parameter::force_limit_N, 0.8f);
  CHECK(arm.largest_step_N(40) <= 0.05f * 0.8f);
  CHECK(arm.force_N().z == doctest::Approx(0.8f).epsilon(1e-3));
  arm.change(Parameter::force_limit_N, 0.3f);
  arm.run(1);
  CHECK(arm.force_N().z == doctest::Approx(0.3f).epsilon(1e-3));
}

TEST_CASE("a force limit that is raised over walls and a program together lets the force grow without a kick") {
  StillArm arm;
  arm.change(Parameter::force_limit_N, 2.0f);
  arm.drive({0.0f, 0.0f, 2.0f}, ForceMode::beside_walls);
  arm.run(100);
  CHECK(arm.force_N().z == doctest::Approx(2.0f).epsilon(1e-3));
  arm.change(Parameter::force_limit_N, 8.0f);
  CHECK(arm.largest_step_N(20) <= 0.05f * 8.0f);
  CHECK(arm.force_N().z == doctest::Approx(3.0f).epsilon(1e-3));
}

TEST_CASE("each limit that reduces the force is reported") {
  StillArm arm;
  CHECK(arm.controller.limits() == 0);
  const auto limits_with = [&](Parameter parameter, float value) {
    arm.change(parameter, value);
    arm.run(1'000);
    return arm.controller.limits();
  };
  const auto bit_of = [](protocol::Limit limit) { return static_cast<std::uint8_t>(limit); };
  CHECK(limits_with(Parameter::force_limit_N, 0.9f) == bit_of(protocol::Limit::force));
  CHECK(arm.controller.signals()[Signal::limits] == 1.0f);
  CHECK(limits_with(Parameter::force_limit_N, 1.1f) == 0);
  CHECK(limits_with(Parameter::current_limit_2_A, 0.01f) == bit_of(protocol::Limit::current));
  CHECK(arm.controller.signals()[Signal::limits] == 2.0f);
  CHECK(std::fabs(arm.controller.signals()[Signal::current_reference_2_A]) == doctest::Approx(0.01f));
  arm.controller.carry_out(tests::command(protocol::Command::stop));
  arm.run(2);
  CHECK(arm.controller.limits() == 0);

  StillArm free;
  free.change(Parameter::box_minimum_z_m, -0.5f);
  free.change(Parameter::force_limit_N, 0.0f);
  free.run(1'000);
  CHECK(free.controller.limits() == 0);
}

TEST_CASE(
    "a program that requests more than the force limit sees this limit, for every direction and report interval") {
  StillArm arm;
  int told = 0;
  const std::uint32_t rhythms[] = {17, 20, 23};
  constexpr int directions = 40;
  for (const std::uint32_t between_reports : rhythms)
    for (int direction = 0; direction < directions; ++direction) {
      const float angle_rad = 0.157f * static_cast<float>(direction);
      for (int report = 0; report < 10; ++report) {
        arm.drive({100.0f * std::cos(angle_rad), 30.0f, 100.0f * std::sin(angle_rad)}, ForceMode::instead_of_walls);
        arm.run(between_reports);
      }
      told += protocol::is_reached(arm.controller.limits(), protocol::Limit::force) ? 1 : 0;
    }
  CHECK(told == static_cast<int>(std::size(rhythms)) * directions);
}

TEST_CASE("without a motor the others make the nearest force that they can") {
  StillArm arm;
  arm.change(Parameter::current_limit_2_A, 0.0f);
  arm.drive({1.0f, 1.0f, 1.0f}, ForceMode::instead_of_walls);
  arm.run(500);
  const auto signals = arm.controller.signals();
  const control::Triple joint_rad{signals[Signal::joint_1_rad], signals[Signal::joint_2_rad],
                                  signals[Signal::joint_3_rad]};
  const auto jacobian = control::forward_kinematics(joint_rad, arm.settings.arm).jacobian;
  const Vector3 asked_N = arm.force_N(), idle = jacobian.column[1];
  const Vector3 nearest_N = asked_N - (control::dot(asked_N, idle) / control::dot(idle, idle)) * idle;
  const control::Triple nearest_Nm = control::joint_torques(jacobian, nearest_N);
  const float torque_1 = signals[Signal::current_reference_1_A] / arm.settings.motors.ampere_per_Nm[0];
  const float torque_3 = signals[Signal::current_reference_3_A] / arm.settings.motors.ampere_per_Nm[2];
  CHECK(signals[Signal::current_reference_2_A] == 0.0f);
  REQUIRE(std::fabs(torque_1) > 1e-5f);
  CHECK(torque_3 / torque_1 == doctest::Approx(nearest_Nm[2] / nearest_Nm[0]).scale(0).epsilon(1e-3));
  const control::Triple whole_Nm = control::joint_torques(jacobian, asked_N);
  CHECK(whole_Nm[2] / whole_Nm[0] != doctest::Approx(nearest_Nm[2] / nearest_Nm[0]).epsilon(0.01));
  CHECK(signals[Signal::torque_2_Nm] == 0.0f);
  CHECK(signals[Signal::torque_3_Nm] == doctest::Approx(nearest_Nm[2]).scale(0).epsilon(1e-3));
}

TEST_CASE("a wall that went while no force was allowed is not felt when one is") {
  StillArm arm;
  arm.change(Parameter::force_limit_N, 0.0f);
  arm.change(Parameter::wall_stiffness_N_per_m, 3000.0f);
  arm.run(100);
  arm.change(Parameter::box_minimum_z_m, arm.parameters[Parameter::box_minimum_z_m] - 0.01f);
  arm.run(100);
  arm.change(Parameter::force_limit_N, 3.3f);
  CHECK(arm.largest_step_N(40) == 0.0f);
  CHECK(arm.force_N().z == 0.0f);
}

TEST_CASE("after a force above the limit disappears, only the limited force is blended out") {
  StillArm arm;
  arm.change(Parameter::box_minimum_z_m, arm.parameters[Parameter::box_minimum_z_m] + 0.03f);  // 31 N
  arm.run(6'000);
  CHECK(arm.force_N().z == doctest::Approx(arm.settings.force_limit_N));
  arm.change(Parameter::box_minimum_z_m, -0.5f);
  CHECK(arm.largest_step_N(52) <= 0.05f * arm.settings.force_limit_N);
  CHECK(arm.force_N().z == 0.0f);
}

TEST_CASE("all together stay below the force limit, in their direction") {
  StillArm arm;
  control::Shapes shapes = arm.floor(0.003f);
  arm.controller.replace_shapes(shapes);
  for (int i = 0; i < 5; ++i) {
    arm.drive({-3.0f, 0.0f, 0.0f}, ForceMode::beside_walls);
    arm.run(800);
  }
  const Vector3 force_N = arm.force_N();
  CHECK(std::sqrt(control::dot(force_N, force_N)) == doctest::Approx(arm.settings.force_limit_N).epsilon(1e-4));
  CHECK(force_N.z / force_N.x == doctest::Approx(-1.0f).epsilon(1e-2));  // the floor and the wall are parallel
}

TEST_CASE("a floor that is pressed with more than the force limit holds the proxy as at the limit") {
  StillArm arm;
  control::Shapes shapes = arm.floor(0.015f);  // 15 N
  shapes.surfaces[0].static_friction = shapes.surfaces[0].dynamic_friction = 0.5f;
  arm.controller.replace_shapes(shapes);
  auto samples = tests::samples_at_rest();
  for (int millisecond = 0; millisecond < 100; ++millisecond) {
    ++samples.encoder_counts[0];
    arm.controller.host_alive();
    tests::run(arm.controller, samples, arm.settings, 20);
  }
  const auto signals = arm.controller.signals();
  const Vector3 proxy_m = arm.controller.proxy_m();
  const float lag_m = std::hypot(proxy_m.x - signals[Signal::position_x_m], proxy_m.y - signals[Signal::position_y_m]);
  CHECK(lag_m == doctest::Approx(0.5f * arm.settings.force_limit_N / 1000.0f).scale(0).epsilon(0.01));
}

TEST_CASE("a program moves nothing while the force is off, and is ramped in with it") {
  const control::Settings settings = control::prepare(parameters_in_wall());
  control::Controller controller = tests::ready_controller(settings);
  controller.drive({{2.0f, 0.0f, 0.0f}, ForceMode::instead_of_walls, 20, 0.05f}, settings);
  const control::Drive drive = tests::run(controller, tests::samples_at_rest(), settings, 100);
  CHECK(!drive.enabled);
  CHECK(controller.signals()[Signal::force_x_N] == 0.0f);
  controller.carry_out(tests::command(protocol::Command::enable_force));
  tests::run(controller, tests::samples_at_rest(), settings, 21);
  // 20 of the 5000 periods of the ramp have passed.
  CHECK(controller.signals()[Signal::force_x_N] == doctest::Approx(2.0f * 20 / 5000).scale(0).epsilon(2e-4));
}

TEST_CASE("when the force is switched off, the remainder of a force jump is discarded") {
  StillArm arm;
  control::Shapes shapes = arm.floor(0.002f);
  arm.controller.replace_shapes(shapes);
  arm.run(1);
  CHECK(arm.force_N().z == doctest::Approx(1.0f).epsilon(0.02));
  arm.controller.carry_out(tests::command(protocol::Command::stop));
  arm.run(2);
  arm.controller.carry_out(tests::command(protocol::Command::enable_force));
  arm.run(21);
  // 20 of the 5000 periods of the ramp have passed. The floor is 2 mm above the probe.
  CHECK(arm.force_N().z == doctest::Approx(2.0f * 20 / 5000).scale(0).epsilon(2e-4));
}

TEST_CASE("late reports are counted") {
  StillArm arm;
  arm.drive({}, ForceMode::beside_walls);
  arm.run(40);
  arm.drive({}, ForceMode::beside_walls);
  CHECK(arm.controller.late_force_reports() == 0);
  arm.run(41);
  arm.drive({}, ForceMode::beside_walls);
  CHECK(arm.controller.late_force_reports() == 1);
}

}  // namespace
