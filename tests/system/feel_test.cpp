// Tests objects that the hand feels: the servo with the flashed image, and the command `inkwell feel`.
#include <doctest/doctest.h>

#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include <glm/geometric.hpp>

#include "host/feel/materials.hpp"
#include "host/feel/servo.hpp"
#include "host/geometry/examples.hpp"
#include "tests/host/import/made_files.hpp"
#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::ForceSource;
using protocol::Parameter;

constexpr std::int64_t periods_per_ms = protocol::servo_rate_Hz / 1000;
constexpr double ball_radius_m = 0.03, tip_radius_m = 0.005;
constexpr glm::dvec3 ball_m{0, 0, -0.03};
constexpr std::uint32_t ball = 3;
constexpr device::Vector3 above_m{0, 0, 0.02};
/// A local model expires after 20 ms. The board then needs up to 25 ms to remove the largest force without a step.
constexpr std::int64_t fade_ms = 50;

double length(const float (&vector)[3]) { return std::hypot(vector[0], vector[1], vector[2]); }

glm::dvec3 vector_of(const float (&values)[3]) { return {values[0], values[1], values[2]}; }

/// A board with the force on, a hand above a fine ball, and the servo.
struct FeelRig : BoardRig {
  FeelRig() {
    set({{Parameter::force_ramp_s, 0.0f}, {Parameter::sphere_radius_m, static_cast<float>(tip_radius_m)}});
    take_to(above_m);
    make_active();
    set({{Parameter::host_timeout_s, 2.0f}});
    parameters = device->parameters();
    auto scene = std::make_shared<contact::Scene>();
    scene->objects.push_back({.id = ball,
                              .shape = geometry::Surface::build(geometry::make_ball(ball_radius_m, 0, 5)),
                              .placement = {ball_m}});
    scene->materials[0] = feel::find_material("smooth")->properties;
    publication.publish(scene);
  }

  /// Advances one millisecond. The servo answers unless it is dead.
  void millisecond() {
    control.run(0.001);
    std::vector<device::Pose> arrived;
    while (auto pose = device->read_pose(0ms)) arrived.push_back(*pose);
    for (std::size_t i = 0; i < arrived.size(); ++i) {
      if (!servo_is_dead) servo.follow(*device, {arrived[i], parameters, 1, seen.empty(), i + 1 == arrived.size()});
      seen.push_back(arrived[i]);
    }
  }
  void pass(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) millisecond();
  }
  /// Moves the hand to a point, and waits until the hand rests.
  void move_to(device::Vector3 target_m) {
    control.hand_path({{0.1, target_m}});
    pass(250);
  }

  contact::Publication publication;
  feel::Servo servo{publication};
  protocol::ParameterSet parameters{};
  bool servo_is_dead = false;
  std::vector<device::Pose> seen;
};

TEST_CASE("a ball pushes back along its normal with stiffness times depth, and not at a distance") {
  FeelRig rig;
  rig.pass(20);
  CHECK(length(rig.seen.back().force_N) == 0.0);
  CHECK_FALSE(protocol::is_felt(rig.seen.back().force_sources, ForceSource::shapes));
  for (const double aside_m : {0.0, 0.012}) {
    CAPTURE(aside_m);
    rig.move_to({aside_m, 0, 0.001});
    const device::Pose& pose = rig.seen.back();
    CHECK(protocol::is_felt(pose.force_sources, ForceSource::shapes));
    const glm::dvec3 out_m = vector_of(pose.position_m) - ball_m, force_N = vector_of(pose.force_N);
    const double depth_m = ball_radius_m + tip_radius_m - glm::length(out_m);
    REQUIRE(depth_m > 0.0005);
    const double stiffness_N_per_m = feel::find_material("smooth")->properties.stiffness_N_per_m;
    CHECK(glm::length(force_N) == doctest::Approx(stiffness_N_per_m * depth_m).scale(0).epsilon(0.1));
    CHECK(glm::dot(glm::normalize(force_N), glm::normalize(out_m)) > 0.998);
  }
  rig.move_to(above_m);
  CHECK(length(rig.seen.back().force_N) == 0.0);
  const auto counted = rig.device->information().report;
  CHECK(counted.force_reports_refused == 0);
  CHECK(counted.force_reports == rig.servo.view().counters.models_sent);
}

TEST_CASE("the model made from a pose acts before the third pose after it") {
  FeelRig rig;
  rig.control.hand_path({{0.1, {0, 0, 0.001}}});
  while (rig.seen.empty() || !protocol::is_felt(rig.seen.back().force_sources, ForceSource::shapes)) {
    rig.millisecond();
    REQUIRE(rig.seen.size() < 200);
  }
  // The model of the newest pose is the reason for the next report, so the first model is older than the felt pose.
  CHECK(rig.device->information().report.force_reports <= 3);
}

TEST_CASE("the force of a killed servo fades: the model expires after 20 ms") {
  FeelRig rig;
  rig.move_to({0, 0, 0.001});
  REQUIRE(length(rig.seen.back().force_N) > 0.5);
  const std::int64_t last_heard = rig.seen.back().time_periods;
  const double before_N = length(rig.seen.back().force_N);
  rig.servo_is_dead = true;
  rig.seen.clear();
  rig.pass(60);
  const auto gone = std::ranges::find_if(rig.seen, [](const auto& pose) { return length(pose.force_N) == 0; });
  REQUIRE(gone != rig.seen.end());
  CHECK(gone->time_periods - last_heard <= fade_ms * periods_per_ms);
  const auto less =
      std::ranges::find_if(rig.seen, [&](const auto& pose) { return length(pose.force_N) < 0.9 * before_N; });
  CHECK(less->time_periods - last_heard <= 25 * periods_per_ms);
  CHECK(protocol::force_is_on(rig.seen.back().state));
}

TEST_CASE("the stylus button grabs the ball, which follows the hand without a force") {
  FeelRig rig;
  rig.move_to({0, 0, 0.001});
  REQUIRE(length(rig.seen.back().force_N) > 0.5);
  rig.control.buttons(true, false);
  rig.pass(80);
  CHECK(rig.servo.view().held == ball);
  CHECK(length(rig.seen.back().force_N) == 0.0);
  const glm::dvec3 hand_before_m = vector_of(rig.seen.back().position_m);
  const glm::dvec3 before_m = rig.servo.view().objects[0].placement.position_m;
  rig.move_to({0.02, 0.01, 0.001});
  const glm::dvec3 moved_m = rig.servo.view().objects[0].placement.position_m - before_m;
  const glm::dvec3 hand_moved_m = vector_of(rig.seen.back().position_m) - hand_before_m;
  CHECK(glm::length(hand_moved_m) > 0.015);
  // The stylus turns with the arm, so the middle of the ball does not move exactly as the tip.
  CHECK(glm::length(moved_m) > 0.01);
  CHECK(length(rig.seen.back().force_N) == 0.0);
  rig.control.buttons(false, false);
  rig.pass(20);
  CHECK_FALSE(rig.servo.view().held);
  const glm::dvec3 released_m = rig.servo.view().objects[0].placement.position_m;
  rig.move_to(above_m);
  CHECK(rig.servo.view().objects[0].placement.position_m == released_m);
}

TEST_CASE("inkwell feel: an example is felt, and its force fades when the program is killed") {
  BoardRig rig;
  rig.set({{Parameter::force_ramp_s, 0.0f}});
  rig.take_to({0, 0, 0.025});
  RunningProgram program({build_directory() + "/inkwell", "--usbip", rig.board.usbip().text(), "--json", "feel",
                          "--example", "ball", "--material", "smooth", "--headless"});
  device::Pose pose{};
  const auto millisecond = [&] {
    rig.control.run(0.001);
    while (const auto next = rig.device->read_pose(0ms)) pose = *next;
  };
  // The program needs some time for its answers.
  const auto run_until = [&](const auto& condition) {
    for (int i = 0; i < 20'000 && !condition(); ++i) {
      millisecond();
      std::this_thread::sleep_for(1ms);
    }
    INFO("state ", std::string(protocol::info(pose.state).name), ", fault ",
         std::string(protocol::info(pose.fault).name), ", height ", pose.position_m[2]);
    REQUIRE(condition());
  };
  run_until([&] { return protocol::force_is_on(pose.state); });
  rig.control.hand_path({{0.2, {0, 0, 0.008}}});
  run_until([&] { return length(pose.force_N) > 0.3; });
  CHECK(protocol::is_felt(pose.force_sources, ForceSource::shapes));
  CHECK(pose.force_N[2] > 0.3f);
  REQUIRE(kill(program.process(), SIGKILL) == 0);
  CHECK_FALSE(program.wait());
  const std::int64_t killed_at = pose.time_periods;
  for (int i = 0; i < 200 && length(pose.force_N) > 0; ++i) millisecond();
  CHECK(length(pose.force_N) == 0.0);
  CHECK(pose.time_periods - killed_at <= fade_ms * periods_per_ms);
}

TEST_CASE("inkwell feel: bad input is one sentence, and nothing is felt") {
  const auto check_refused = [](const std::vector<std::string>& arguments, int exit_code, const char* sentence) {
    const ProgramResult result = run_program("inkwell", arguments);
    INFO("standard error: ", result.err);
    CHECK(result.exit_code == exit_code);
    CHECK(result.err.find(sentence) != std::string::npos);
    CHECK(result.out.empty());
  };
  const TemporaryDirectory directory;
  check_refused({"feel", "--example", "cheese", "--headless", "--virtual"}, 1,
                "There is no example cheese. Choose one of these: ball, cylinder, gear");
  check_refused({"feel", "--example", "ball", "--material", "cheese"}, 2, "There is no material cheese. Choose one of");
  check_refused({"feel"}, 2, "Name one object");
  check_refused({"feel", "a.stl", "--example", "ball"}, 2, "Name one object");
  check_refused({"feel", directory.file("missing.stl"), "--headless"}, 1, "missing.stl");
  check_refused({"feel", "--example", "ball", "--scale", "10", "--headless"}, 1, "Or use --fit.");
  check_refused({"feel", "--example", "ball", "--json"}, 2, "--headless");
  check_refused({"feel", "--example", "ball", "--unit", "mm"}, 2, "--unit");
}

}  // namespace
}  // namespace inkwell::tests
