// Tests forces and shapes of a program on the PC, and their removal when the program stops.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/system/board_rig.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::ForceMode;
using protocol::ForceSource;
using protocol::Parameter;

constexpr float force_limit_N = 3.3f;
constexpr std::uint32_t periods_per_ms = protocol::servo_rate_Hz / 1000;

/// A board with the force on. A hand holds the arm in free space.
struct ProgramRig : BoardRig {
  ProgramRig() {
    set({{Parameter::force_ramp_s, 0.0f}, {Parameter::force_limit_N, force_limit_N}});
    take_to(free_point_m);
    make_active();
    // The program's force must expire before the host timeout.
    set({{Parameter::host_timeout_s, 2.0f}});
    newest = pose();
  }

  /// Advances one millisecond and returns the poses that the device sent.
  std::vector<device::Pose> millisecond() {
    control.run(0.001);
    std::vector<device::Pose> seen;
    while (auto pose = device->read_pose(0ms)) seen.push_back(newest = *pose);
    return seen;
  }
  device::Pose newest{};  ///< newest pose that millisecond() has received

  /// Sends the same force every millisecond and returns the received poses.
  std::vector<device::Pose> drive(const device::ForceRequest& request, int milliseconds) {
    std::vector<device::Pose> seen;
    for (int i = 0; i < milliseconds; ++i) {
      device->send_force(request);
      for (const auto& pose : millisecond()) seen.push_back(pose);
    }
    return seen;
  }
};

double length(const float (&vector)[3]) { return std::hypot(vector[0], vector[1], vector[2]); }

/// Returns the largest force change per millisecond between two poses.
double largest_step_N(const std::vector<device::Pose>& poses) {
  double largest_N = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto& before = poses[i - 1];
    const double change_N = std::hypot(poses[i].force_N[0] - before.force_N[0], poses[i].force_N[1] - before.force_N[1],
                                       poses[i].force_N[2] - before.force_N[2]);
    const double milliseconds = static_cast<double>(poses[i].time_periods - before.time_periods) / periods_per_ms;
    largest_N = std::max(largest_N, change_N / std::max(1.0, milliseconds));
  }
  return largest_N;
}

TEST_CASE(
    "the force of a program is felt and reported, and ends within its expiry plus 10 ms when the program is killed") {
  ProgramRig rig;
  const auto before = rig.control.truth().at("true_position_x_m").get<double>();
  const auto poses = rig.drive({.force_N = {1.0f, 0.0f, 0.0f}}, 200);
  REQUIRE(poses.size() > 190);
  CHECK(poses.back().force_N[0] == doctest::Approx(1.0).epsilon(1e-3));
  CHECK(protocol::is_felt(poses.back().force_sources, ForceSource::program));
  CHECK(protocol::is_felt(poses.back().force_sources, ForceSource::walls));
  // The hand is a spring of 1500 N/m.
  CHECK(rig.control.truth().at("true_position_x_m").get<double>() - before ==
        doctest::Approx(1.0 / 1500).scale(0).epsilon(0.3));

  std::vector<device::Pose> silence;
  for (int i = 0; i < 80; ++i)
    for (const auto& pose : rig.millisecond()) silence.push_back(pose);
  const std::int64_t last_heard = poses.back().time_periods;
  const auto is_gone = [](const auto& pose) { return pose.force_N[0] == 0.0f; };
  const auto gone = std::find_if(silence.begin(), silence.end(), is_gone);
  REQUIRE(gone != silence.end());
  // The bound of the delay is two bus frames plus two control periods.
  CHECK(gone->time_periods - last_heard <= (50 + 10 + 2) * periods_per_ms + 2);
  CHECK(gone->time_periods - last_heard >= 50 * periods_per_ms);
  CHECK(std::all_of(gone, silence.end(), is_gone));
  CHECK(!protocol::is_felt(silence.back().force_sources, ForceSource::program));
  CHECK(protocol::force_is_on(silence.back().state));

  const auto counted = rig.device->information().report;
  CHECK(counted.force_reports == 200);
  CHECK(counted.force_reports_lost == 0);
  CHECK(counted.force_reports_refused == 0);
}

TEST_CASE("a huge force is the force limit in its direction, a program that ends fades at once") {
  ProgramRig rig;
  const auto poses = rig.drive({.force_N = {3e30f, 0.0f, -4e30f}}, 40);
  CHECK(length(poses.back().force_N) == doctest::Approx(force_limit_N).epsilon(1e-3));
  CHECK(poses.back().force_N[2] / poses.back().force_N[0] == doctest::Approx(-4.0 / 3.0).epsilon(1e-3));
  CHECK(largest_step_N(poses) <= info(Parameter::program_force_change_N_per_s).default_value * 1.1e-3);
  rig.device->send_force({.mode = ForceMode::none});
  std::vector<device::Pose> end;
  for (int i = 0; i < 15; ++i)
    for (const auto& pose : rig.millisecond()) end.push_back(pose);
  CHECK(length(end.back().force_N) == 0.0);
}

TEST_CASE("an invalid force or shape is refused with a sentence before it is sent") {
  ProgramRig rig;
  CHECK_THROWS_WITH_AS(rig.device->send_force({.force_N = {std::numeric_limits<float>::quiet_NaN(), 0, 0}}),
                       "The force is nan N on one axis. Give finite numbers.", device::Error);
  CHECK_THROWS_WITH_AS(rig.device->send_force({.interval_ms = 51}),
                       "A force for 51 ms cannot be sent. Send a force every 1 to 50 ms, and give this interval.",
                       device::Error);
  device::Shapes shapes;
  shapes.planes[3] = device::Plane{.normal = {0, 0, 0}};
  CHECK_THROWS_WITH_AS(rig.device->place_shapes(shapes),
                       "The normal of plane 3 has length 0. Give a normal that points into the free space.",
                       device::Error);
  shapes.planes[3] = device::Plane{.surface = {.stiffness_N_per_m = 1e6f}};
  CHECK_THROWS_AS(rig.device->place_shapes(shapes), device::Error);
  CHECK(rig.device->information().report.force_reports == 0);
}

TEST_CASE("a program that pushes along with every motion gives the hand no more than the reserve") {
  const auto delivered_J = [](float power_given_W) {
    ProgramRig rig;
    rig.set({{Parameter::power_given_W, power_given_W}});
    std::vector<device::HandWaypoint> path;
    for (int i = 1; i <= 8; ++i)
      path.push_back({0.15 * i, {free_point_m[0] + (i % 2 == 0 ? -0.03 : 0.03), free_point_m[1], free_point_m[2]}});
    rig.control.hand_path(path);
    rig.control.meter_start();
    double before_m = free_point_m[0];
    bool reported = false;
    for (int i = 0; i < 1200; ++i) {
      const double moved_m = rig.newest.position_m[0] - before_m;
      before_m = rig.newest.position_m[0];
      const float push_N = moved_m < 0.0 ? -2.5f : 2.5f;
      rig.device->send_force({.force_N = {push_N, 0.0f, 0.0f}, .mode = ForceMode::instead_of_walls});
      for (const auto& seen : rig.millisecond()) reported |= protocol::is_reached(seen.limits, protocol::Limit::energy);
    }
    CHECK(reported == (power_given_W == 0.0f));
    return rig.control.meter_read().energy_J;
  };
  const double bounded_J = delivered_J(0.0f), unbounded_J = delivered_J(20.0f);
  MESSAGE("simulation: given to the hand in 1.2 s: ", bounded_J, " J, without the bound ", unbounded_J, " J");
  CHECK(bounded_J < 0.5 * unbounded_J);
}

TEST_CASE("without a hand, a program force cannot make the arm faster than the speed limit") {
  const auto fastest_m_per_s = [](float speed_limit_m_per_s) {
    ProgramRig rig;
    rig.set({{Parameter::speed_limit_m_per_s, speed_limit_m_per_s}, {Parameter::power_given_W, 20.0f}});
    rig.control.hand({false, {}, 0, 0});
    double fastest = 0.0;
    bool reported = false;
    for (int i = 0; i < 1500; ++i) {
      // The force always points to the center, so the probe oscillates around the center.
      const double x_m = rig.newest.position_m[0] - free_point_m[0];
      rig.device->send_force({.force_N = {x_m > 0.0 ? -3.0f : 3.0f, 0.0f, 0.5f}, .mode = ForceMode::beside_walls});
      for (const auto& seen : rig.millisecond()) reported |= protocol::is_reached(seen.limits, protocol::Limit::speed);
      const auto truth = rig.control.truth();
      const auto speed = [&](const char* name) { return truth.at(name).get<double>(); };
      fastest = std::max(fastest, std::hypot(speed("true_velocity_x_m_s"), speed("true_velocity_y_m_s"),
                                             speed("true_velocity_z_m_s")));
    }
    CHECK(rig.newest.fault == protocol::Fault::none);
    CHECK(reported == (speed_limit_m_per_s < 3.0f));
    return fastest;
  };
  const double held_m_per_s = fastest_m_per_s(2.0f), free_m_per_s = fastest_m_per_s(10.0f);
  MESSAGE("simulation: ", held_m_per_s, " m/s at a limit of 2 m/s, ", free_m_per_s, " m/s without");
  CHECK(held_m_per_s < 2.0);
  CHECK(free_m_per_s > 2.4);
}

TEST_CASE("disable_force reduces the force of a pressing hand slowly, and a stop removes it immediately") {
  ProgramRig rig;
  rig.set({{Parameter::box_minimum_z_m, -0.015f}});
  rig.run(0.1);
  const double pressed_N = length(rig.pose().force_N);
  REQUIRE(pressed_N > 1.0);
  rig.device->send(protocol::Command::disable_force);
  std::vector<device::Pose> seen{rig.pose()};
  for (int i = 0; i < 80; ++i)
    for (const auto& pose : rig.millisecond()) seen.push_back(pose);
  CHECK(length(seen.back().force_N) == 0.0);
  CHECK(seen.back().state == protocol::State::ready);
  CHECK(largest_step_N(seen) < 0.05 * force_limit_N);

  rig.make_active();
  rig.run(0.1);
  REQUIRE(length(rig.pose().force_N) > 0.9 * pressed_N);
  rig.device->send(protocol::Command::stop);
  rig.run(0.01);  // latency of the command and of the pose
  CHECK(length(rig.pose().force_N) == 0.0);
}

TEST_CASE("a floor that moves 5 mm under a hand that presses with 1 N never kicks") {
  ProgramRig rig;
  constexpr float stiffness_N_per_m = 800;
  std::function<void(double)> move_floor;  // to the height at which the floor touches the center of the probe
  auto whose = ForceSource::walls;
  SUBCASE("a program's plane") {
    whose = ForceSource::shapes;
    move_floor = [&](double z_m) {
      device::Shapes shapes;
      shapes.planes[0] =
          device::Plane{.point_m = {0, 0, static_cast<float>(z_m)},
                        .normal = {0, 0, 1},
                        .surface = {.stiffness_N_per_m = stiffness_N_per_m, .damping_Ns_per_m = 2, .life_s = 5}};
      rig.device->place_shapes(shapes);
    };
  }
  SUBCASE("a wall of the box") {
    rig.set({{Parameter::sphere_radius_m, 0.0f}, {Parameter::wall_stiffness_N_per_m, stiffness_N_per_m}});
    move_floor = [&](double z_m) { rig.set({{Parameter::box_minimum_z_m, static_cast<float>(z_m)}}); };
  }
  // A soft hand presses with 1 N on the floor.
  constexpr double hand_N_per_m = 200;
  rig.control.hand({.holds = true, .target_m = free_point_m, .stiffness_N_per_m = hand_N_per_m});
  rig.run(0.3);
  const double z_m = rig.control.truth().at("true_position_z_m").get<double>();
  move_floor(z_m);
  device::Vector3 target_m = free_point_m;
  target_m[2] = z_m - 1.0 / hand_N_per_m - 1.0 / stiffness_N_per_m;
  rig.control.hand_path({{0.0, free_point_m}, {0.3, target_m}});
  rig.run(0.8);
  CHECK(rig.pose().force_N[2] == doctest::Approx(1.0).epsilon(0.1));
  CHECK(protocol::is_felt(rig.pose().force_sources, whose));
  // Each upward move is observed for 0.3 s. Each downward move is observed until the hand has followed the floor.
  struct Move {
    double by_m;
    int milliseconds;
  };
  double floor_m = z_m;
  for (const Move& move : {Move{0.005, 300}, {-0.005, 8}}) {
    CAPTURE(move.by_m);
    floor_m += move.by_m;
    std::vector<device::Pose> poses{rig.pose()};
    move_floor(floor_m);
    for (int i = 0; i < move.milliseconds; ++i)
      for (const auto& pose : rig.millisecond()) poses.push_back(pose);
    MESSAGE("simulation: a floor moved by ", 1e3 * move.by_m, " mm changes the force by at most ",
            largest_step_N(poses), " N in a millisecond");
    CHECK(largest_step_N(poses) <= 0.05 * force_limit_N);
    rig.run(0.5);
  }
}

TEST_CASE("a shape that is not placed again ends after its life") {
  ProgramRig rig;
  device::Shapes shapes;
  shapes.sphere = device::Sphere{.centre_m = {0, 0, 0.5f}, .radius_m = 0.01f, .surface = {.life_s = 0.1f}};
  rig.device->place_shapes(shapes);
  rig.run(0.05);
  CHECK(protocol::is_felt(rig.pose().force_sources, ForceSource::shapes));
  rig.run(0.1);
  CHECK(!protocol::is_felt(rig.pose().force_sources, ForceSource::shapes));
}

}  // namespace
}  // namespace inkwell::tests
