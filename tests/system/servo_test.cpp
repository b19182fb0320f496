// Tests the processor load of the control interrupt, and the motor heat.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "boards/omni_driver/facts.hpp"
#include "firmware/control/signal_path/local_model.hpp"
#include "firmware/control/signal_path/shapes.hpp"
#include "host/client/crash/firmware_image.hpp"

#include "tests/stepped_board.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/cycles_page.hpp"
#include "tests/system/firmware_image.hpp"
#include "tests/system/hazards.hpp"
#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;
using protocol::Signal;

namespace {

double mean_square(const device::Trace& trace, const std::string& column) {
  const auto found = std::find(trace.columns.begin(), trace.columns.end(), column);
  REQUIRE(found != trace.columns.end());
  REQUIRE(trace.row_count() > 0);
  double sum = 0;
  for (auto i = static_cast<std::size_t>(found - trace.columns.begin()); i < trace.values.size();
       i += trace.columns.size())
    sum += trace.values[i] * trace.values[i];
  return sum / static_cast<double>(trace.row_count());
}

}  // namespace

namespace {

/// Half of the period plus a margin. The margin covers the energy and rate limits, a simultaneous state change, and the
/// code placement.
constexpr std::uint32_t tolerated_cycles = board::servo_cycles / 2 + 500;

}  // namespace

TEST_CASE(
    "the longest control interrupt leaves nearly half of its period, pressed into three walls and with a full scope") {
  BoardRig rig(device::SimulationMode::fast, 1, device::CyclePricing::conservative);
  rig.make_active();
  std::vector<Signal> signals;
  for (std::uint8_t id = 0; id < 31; ++id) signals.push_back(static_cast<Signal>(id));
  rig.device->select_signals(signals);
  rig.take_to(free_point_m);
  // The probe presses against three walls.
  rig.set(
      {{Parameter::box_minimum_z_m, -0.02f}, {Parameter::box_maximum_x_m, 0.0f}, {Parameter::box_maximum_y_m, 0.0f}});
  rig.take_to({0.02, 0.02, -0.045}, 0.3);
  const auto& forces = rig.pose().force_N;
  CHECK((forces[0] < 0.0f && forces[1] < 0.0f && forces[2] > 0.0f));
  rig.take_to(free_point_m, 0.3);
  const auto report = rig.device->information().report;
  MESSAGE("simulation: longest control interrupt ", report.servo_cycles_longest, " of ", board::servo_cycles,
          " cycles");
  CHECK(report.servo_cycles_longest > 500);  // the interrupt ran and was measured
  CHECK(report.servo_cycles_longest < tolerated_cycles);
  check_figure_on_cycles_page("longest control interrupt", report.servo_cycles_longest);
  CHECK(report.servo_overruns == 0);
  // Each pose contains the longest interrupt time in units of 1/255 period.
  const auto largest = std::ranges::max_element(rig.poses(), {}, &device::Pose::servo_load)->servo_load;
  const double reported_cycles = largest / 255.0 * board::servo_cycles;
  CHECK(reported_cycles <= report.servo_cycles_longest);
  CHECK(reported_cycles > 0.9 * report.servo_cycles_longest);
  // Flash prefetch and cache accelerate the main loop but not the interrupts.
  const double sleep_share = rig.control.status().all.at("sleep_share").get<double>();
  MESSAGE("simulation: the processor sleeps ", sleep_share, " of the time");
  // The alignment of the main loop's functions to cache lines changes the result by a few percent.
  CHECK(sleep_share > 0.08);
}

namespace {

/// Returns the longest duration of the contact stage in the next 0.1 s.
float contact_cycles(BoardRig& rig) {
  while (rig.device->read_scope(std::chrono::milliseconds(0))) {
  }
  rig.run(0.1);
  float longest = 0;
  while (const auto samples = rig.device->read_scope(std::chrono::milliseconds(0)))
    for (const float cycles : samples->values) longest = std::max(longest, cycles);
  return longest;
}

/// Returns eight planes around a point. The first `touched` planes are one millimeter above the point.
device::Shapes eight_planes(const device::Vector3& point_m, std::size_t touched, float friction) {
  device::Shapes shapes;
  for (std::size_t i = 0; i < shapes.planes.size(); ++i) {
    const auto angle_rad = 2.1f * static_cast<float>(i);
    const std::array normal{0.6f * std::cos(angle_rad), 0.6f * std::sin(angle_rad), 0.8f};
    const float height_m = i < touched ? 0.001f : -0.02f;
    device::Plane plane{.normal = normal,
                        .surface = {.static_friction = friction, .dynamic_friction = 0.5f * friction, .life_s = 10}};
    for (std::size_t axis = 0; axis < 3; ++axis)
      plane.point_m[axis] = static_cast<float>(point_m[axis]) + height_m * normal[axis];
    shapes.planes[i] = plane;
  }
  return shapes;
}

}  // namespace

TEST_CASE(
    "in the longest control interrupt, checks execute at most 310 instructions, or 430 with a state change, and "
    "voltage bounds at most 100") {
  const auto profile = std::filesystem::temp_directory_path() / fmt::format("inkwell-checks-{}", getpid());
  {
    auto options = stepped_board(device::SimulationMode::exact, device::CyclePricing::likely);
    options.profile = profile;
    BoardRig rig(options);
    rig.make_active();
    rig.take_to(free_point_m);
    rig.set(
        {{Parameter::box_minimum_z_m, -0.02f}, {Parameter::box_maximum_x_m, 0.0f}, {Parameter::box_maximum_y_m, 0.0f}});
    rig.take_to({0.02, 0.02, -0.045}, 0.3);
  }
  std::vector<std::uint32_t> executed;
  std::ifstream file(profile);
  for (std::string address, cycles; file >> address >> cycles;)
    executed.push_back(static_cast<std::uint32_t>(std::stoul(address, nullptr, 16)));
  std::filesystem::remove(profile);
  const auto instructions_in = [&](std::initializer_list<std::string_view> functions) {
    std::ptrdiff_t count = 0;
    for (const auto function : functions)
      count += std::ranges::count_if(
          executed, [symbol = find_symbol(function)](std::uint32_t address) { return symbol.contains(address); });
    return count;
  };
  const auto checking = instructions_in({"Controller9supervise", "Controller12check_motors"});
  const auto heartbeat = instructions_in({"Bridges12begin_period", "Bridges10end_period"});
  const auto heat = instructions_in({"MotorHeat6update"});
  const auto bounds = instructions_in({"Controller14bound_voltages"});
  // The motor check calls update_resistance() once per 128 checks of a motor.
  const auto resistance = instructions_in({"Controller17update_resistance"});
  const crash::FirmwareImage image(build_directory() + "/../board/inkwell.elf");
  const auto conditioning_by = [&](std::string_view header) {
    return std::ranges::count_if(executed, [&](std::uint32_t address) {
      const std::string location = image.source_location(address);
      return location.find("condition_samples") != location.npos &&
             location.find(fmt::format("({}:", header)) != location.npos;
    });
  };
  const auto jumps = conditioning_by("encoders.hpp");
  // The debug information assigns four instructions of the comparison to the calling line. The count includes three
  // store instructions of other code.
  const auto current_jumps = conditioning_by("current_jump.hpp") + 4 - 3;
  const auto change_of_state = instructions_in({"Controller12change_state", "7control7advanceERKNS0_10Supervisor"});
  MESSAGE("simulation: of ", executed.size(), " instructions ", checking, " supervise, ", heartbeat,
          " are the heartbeat's, ", jumps, " look for jumps of encoders, ", current_jumps, " of currents, ", heat,
          " are the motors' heat, ", bounds, " the bounds of the loops' voltages, ", resistance,
          " the motors' resistance, ", change_of_state, " a change of state");
  CHECK(executed.size() > 1'000);
  CHECK(checking > 100);
  CHECK(heartbeat > 10);
  CHECK(jumps > 10);
  CHECK(current_jumps > 10);
  CHECK(heat > 10);
  // A limit may change its state during the longest interrupt.
  CHECK(checking + heartbeat + jumps + current_jumps + heat + change_of_state <= (change_of_state > 0 ? 430 : 310));
  CHECK(bounds > 10);
  CHECK(bounds + resistance <= 100);
}

TEST_CASE("eight planes cost at most 300 cycles while none is touched") {
  BoardRig rig(device::SimulationMode::fast, 1, device::CyclePricing::conservative);
  rig.make_active();
  rig.take_to(free_point_m);
  rig.device->select_signals(std::array{Signal::stage_contact_cycles});
  const float without = contact_cycles(rig);
  rig.device->place_shapes(eight_planes(free_point_m, 0, 0.0f));
  rig.run(0.1);
  const float with = contact_cycles(rig);
  MESSAGE("simulation: contact stage ", without, " cycles without shapes, ", with, " with eight planes");
  CHECK(with > without);
  check_figure_on_cycles_page("contact stage without shapes", without);
  check_figure_on_cycles_page("contact stage with eight planes", with);
  CHECK(with - without <= 300.0f);
}

namespace {

/// Three features around a point, each touched 1 mm deep, with friction.
device::LocalModel three_features(const device::Vector3& point_m, bool are_curved_and_moving) {
  device::LocalModel model;
  const auto coordinate = [&](std::size_t axis) { return static_cast<float>(point_m[axis]); };
  model.anchor_m = {coordinate(0), coordinate(1), coordinate(2)};
  model.velocity_m_per_s = {0.001f, 0.002f, -0.001f};
  model.spin_rad_per_s = {0.25f, 0.25f, 0.0f};
  model.count = 3;
  for (std::size_t i = 0; i < model.count; ++i) {
    const auto angle_rad = 2.1f * static_cast<float>(i);
    const std::array normal{0.6f * std::cos(angle_rad), 0.6f * std::sin(angle_rad), 0.8f};
    device::Feature& feature = model.features[i];
    feature.kind = !are_curved_and_moving ? protocol::FeatureKind::plane
                   : i == 0               ? protocol::FeatureKind::sphere
                                          : protocol::FeatureKind::cylinder;
    feature.radius_m = are_curved_and_moving ? 0.005f : 0.0f;
    feature.moves = are_curved_and_moving;
    feature.direction = feature.kind == protocol::FeatureKind::cylinder
                            ? std::array{-std::sin(angle_rad), std::cos(angle_rad), 0.0f}
                            : normal;
    for (std::size_t axis = 0; axis < 3; ++axis)
      feature.point_m[axis] = coordinate(axis) + (0.001f - feature.radius_m) * normal[axis];
  }
  return model;
}

/// Returns the longest duration of the contact stage while the features are sent each millisecond.
float contact_cycles(BoardRig& rig, const device::LocalModel& model) {
  while (rig.device->read_scope(std::chrono::milliseconds(0))) {
  }
  float longest = 0;
  for (int i = 0; i < 150; ++i) {
    rig.device->send_local_model(model, {.mode = protocol::ForceMode::beside_walls});
    rig.control.run(0.001);
    while (rig.device->read_pose(std::chrono::milliseconds(0))) {
    }
    while (const auto samples = rig.device->read_scope(std::chrono::milliseconds(0)))
      if (i >= 50)  // the features have risen to the probe
        for (const float cycles : samples->values) longest = std::max(longest, cycles);
  }
  return longest;
}

}  // namespace

TEST_CASE(
    "three touched curved moving features with friction cost no more cycles than three touched planes, and no more "
    "memory") {
  const auto longest_contact_stage = [&](bool are_features) {
    BoardRig rig(device::SimulationMode::fast, 1, device::CyclePricing::conservative);
    rig.make_active();
    rig.take_to(free_point_m);
    rig.device->select_signals(std::array{Signal::stage_contact_cycles});
    device::Shapes shapes;
    if (!are_features) shapes = eight_planes(free_point_m, 3, 0.06f);
    shapes.materials = {{500, 0, 0.06f, 0.03f, 0}};
    rig.device->place_shapes(shapes);
    rig.run(0.1);
    // The cycles depend on the hand: it sticks or slides, and two or three surfaces support the proxy.
    float longest = 0;
    for (const device::Vector3& target_m : {offset_from_free_point(4e-4, 0, 0), offset_from_free_point(-2e-4, 3e-4, 0),
                                            offset_from_free_point(-2e-4, -3e-4, 0)}) {
      rig.control.hand_path({{0.0, free_point_m}, {0.05, free_point_m}, {0.1, target_m}});
      longest = std::max(longest,
                         are_features ? contact_cycles(rig, three_features(free_point_m, true)) : contact_cycles(rig));
    }
    CHECK(rig.device->information().report.servo_cycles_longest < board::servo_cycles * 0.875);
    return longest;
  };
  const float with_planes = longest_contact_stage(false), with_features = longest_contact_stage(true);
  MESSAGE("simulation: contact stage ", with_planes, " cycles with three touched planes of eight, ", with_features,
          " with a sphere and two cylinders that move");
  CHECK(with_features <= with_planes);
  // The memory of a set of shapes that contains only planes.
  using control::Shapes;
  constexpr std::size_t planes_bytes =
      Shapes::planes_maximum * (sizeof(control::Plane) + sizeof(control::Surface) + sizeof(std::uint32_t));
  CHECK(sizeof(control::LocalModel) <= planes_bytes);
  check_figure_on_cycles_page("contact stage with three touched planes", with_planes);
  check_figure_on_cycles_page("contact stage with three touched features", with_features);
}

namespace {

/// Objects besides the three walls.
struct Touched {
  std::size_t planes, solids, features;
};

/// Boxes and cylinders. Their surfaces are 0.5 mm above a point.
void add_solids(device::Shapes& shapes, const device::Vector3& point_m, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    device::Solid solid{.kind = i % 2 == 0 ? protocol::SolidKind::box : protocol::SolidKind::cylinder,
                        .size_m = {0.02f, 0.02f, 0.02f},
                        .surface = {.static_friction = 0.4f, .dynamic_friction = 0.2f, .life_s = 10}};
    for (std::size_t axis = 0; axis < 3; ++axis)
      solid.centre_m[axis] = static_cast<float>(point_m[axis]) + (axis == i % 3 ? 0.0195f : 1e-4f);
    shapes.solids.push_back(solid);
  }
}

}  // namespace

TEST_CASE("the control interrupt ends within its period while the hand touches many objects at the same time") {
  for (const Touched touched : {Touched{.planes = 0, .solids = 0, .features = 3},
                                {.planes = 8, .solids = 0, .features = 0},
                                {.planes = 0, .solids = 8, .features = 0}}) {
    BoardRig rig(device::SimulationMode::fast, 1, device::CyclePricing::conservative);
    rig.make_active();
    rig.set(
        {{Parameter::box_minimum_z_m, -0.02f}, {Parameter::box_maximum_x_m, 0.0f}, {Parameter::box_maximum_y_m, 0.0f}});
    const device::Vector3 beside_m = offset_from_free_point(-0.003, -0.003, -0.003);
    rig.take_to(beside_m);
    device::Shapes shapes;
    if (touched.planes > 0) shapes = eight_planes(free_point_m, touched.planes, 0.4f);
    add_solids(shapes, free_point_m, touched.solids);
    shapes.materials = {{500, 1, 0.4f, 0.2f, 1}};
    rig.device->place_shapes(shapes);
    rig.control.hand_path({{0.0, beside_m}, {0.05, offset_from_free_point(0.001, 0.001, 0.001)}});
    for (int time_ms = 0; time_ms < 80; ++time_ms) {
      if (touched.features > 0)
        rig.device->send_local_model(three_features(free_point_m, true), {.mode = protocol::ForceMode::beside_walls});
      rig.control.run(0.001);
      while (rig.device->read_pose(std::chrono::milliseconds(0))) {
      }
    }
    const auto report = rig.device->information().report;
    MESSAGE("simulation: longest control interrupt ", report.servo_cycles_longest, " with walls, planes ",
            touched.planes, ", solids ", touched.solids, ", features ", touched.features);
    CHECK(report.servo_cycles_longest > 6000);
    CHECK(report.servo_overruns == 0);
  }
}

TEST_CASE("the heat of a motor that presses against a wall follows its true current") {
  BoardRig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::box_maximum_z_m, -0.04f},
           {Parameter::winding_time_constant_s, 0.25f},
           {Parameter::winding_heat_part, 1.0f}});
  rig.run(2.0);
  rig.control.trace_start();
  rig.run(0.1);
  const device::Trace trace = rig.control.trace_read(100'000);
  const auto report = rig.device->information().report;
  const auto parameters = rig.device->parameters();
  const double bears_A = parameters[Parameter::continuous_current_1_A];
  double hottest = 0;
  for (std::size_t motor = 0; motor < 3; ++motor) {
    const double heat = mean_square(trace, "true_current_" + std::to_string(motor + 1) + "_A") / (bears_A * bears_A);
    CAPTURE(motor);
    CHECK(std::fabs(report.motor_heat[motor] - heat) < 0.02 + 0.03 * heat);
    hottest = std::max(hottest, heat);
  }
  MESSAGE("simulation: heat of the hottest motor ", hottest, " of what its continuous current leads to");
  CHECK(hottest > 0.1);
}

TEST_CASE("a motor that was warm before a restart is as warm after it, but not after the power was cut") {
  BoardRig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::box_maximum_z_m, -0.04f},
           {Parameter::winding_time_constant_s, 0.25f},
           {Parameter::winding_heat_part, 0.5f},
           {Parameter::housing_time_constant_s, 1.0f}});
  rig.run(1.0);
  const auto hottest = [&] { return std::ranges::max(rig.device->information().report.motor_heat); };
  const auto is_kept = [&](float before) {
    // The heat decays slowly with the default parameters.
    const float after = hottest();
    MESSAGE("simulation: heat ", before, " before the restart, ", after, " after it");
    CHECK(after > 0.9f * before);
    CHECK(after < 1.02f * before);
  };
  const float warm = hottest();
  REQUIRE(warm > 0.1f);
  SUBCASE("by the reset pin, twice at once") {
    rig.control.reset();
    rig.control.run(0.02);
    rig.control.reset();
    reconnect(rig);
    is_kept(warm);
  }
  SUBCASE("by the watchdog") {
    rig.control.inject({"main_loop_stalled", "", 10.0});
    rig.control.run(0.06);
    reconnect(rig);
    CHECK(watchdog_expires(rig.control) == 1);
    is_kept(warm);
  }
  rig.control.cut_power();
  reconnect(rig);
  CHECK(hottest() < 1e-3f);  // heat of the self-test
  rig.control.reset();
  reconnect(rig);
  CHECK(hottest() < 1e-3f);  // heat of the self-test
}

TEST_CASE(
    "an overloaded motor gets less current, all three currents are scaled down together, and no fault is raised") {
  BoardRig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::winding_time_constant_s, 0.5f},
           {Parameter::housing_time_constant_s, 2.0f},
           {Parameter::continuous_current_1_A, 0.5f},
           {Parameter::continuous_current_2_A, 0.5f},
           {Parameter::continuous_current_3_A, 0.5f},
           {Parameter::box_maximum_z_m, -0.04f}});
  const auto currents_A = [&] {
    const auto truth = rig.control.truth();
    std::array<double, 3> currents{};
    for (std::size_t i = 0; i < 3; ++i) currents[i] = truth.at(fmt::format("true_current_{}_A", i + 1)).get<double>();
    return currents;
  };
  rig.run(0.15);
  const auto while_cool_A = currents_A();
  CHECK(largest_current_A(rig.control) > 1.0);
  rig.device->select_signals(std::vector{Signal::motor_heat_1, Signal::motor_heat_2, Signal::motor_heat_3});
  float hottest = 0;
  for (int i = 0; i < 60; ++i) {
    rig.run(0.1);
    while (const auto samples = rig.device->read_scope(std::chrono::milliseconds(0)))
      if (!samples->values.empty()) hottest = std::max(hottest, std::ranges::max(samples->values));
  }
  const auto report = rig.device->information().report;
  const float heat = *std::ranges::max_element(report.motor_heat);
  MESSAGE("simulation: at most ", hottest, " of the heat that the motors bear, ", heat, " in the end");
  CHECK(heat > 0.9f);
  CHECK(hottest < 1.1f);
  CHECK(protocol::force_is_on(rig.pose().state));
  CHECK(protocol::is_reached(rig.pose().limits, protocol::Limit::heat));
  CHECK(largest_current_A(rig.control) == doctest::Approx(0.5).epsilon(0.1));
  // The force still has the same direction, but the hand has moved slightly.
  const auto now_A = currents_A();
  const double along = std::inner_product(now_A.begin(), now_A.end(), while_cool_A.begin(), 0.0);
  const auto length = [](const auto& v) { return std::hypot(v[0], v[1], v[2]); };
  CHECK(along / (length(now_A) * length(while_cool_A)) > 0.999);
}
