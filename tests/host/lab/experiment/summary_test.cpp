#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "host/client/recording/signals.hpp"
#include "host/lab/experiment/summary_json.hpp"

using namespace inkwell;
using namespace inkwell::experiment;
using protocol::Parameter;

namespace {

using protocol::Signal;
using recording::Recording;

/// Signals of the recording that `fill` does not set are zero.
Recording synthetic(std::size_t samples, const std::function<void(std::size_t, protocol::SignalValues&)>& fill) {
  recording::Information about;
  about.signals = recording::signal_path();
  about.parameters = protocol::default_parameters();
  device::ScopeSamples scope{.signals = about.signals, .first_period = 500, .count = samples, .values = {}};
  for (std::size_t i = 0; i < samples; ++i) {
    protocol::SignalValues values{};
    fill(i, values);
    for (const auto signal : scope.signals) scope.values.push_back(values[signal]);
  }
  auto recording = Recording::without_samples(about);
  recording.append(scope);
  return recording;
}

/// The probe pushes into the upper z wall, with 0.4 N at rest. The force deviates from the force law by `error_N`.
Recording push(double error_N = 0) {
  return synthetic(20'000, [&](std::size_t i, protocol::SignalValues& values) {
    if (i < 5000 || i >= 17'000) return;
    const bool steady = i >= 6000;
    values[Signal::penetration_z_m] = -0.0005f;
    values[Signal::velocity_z_m_s] = steady ? 0.0f : 0.1f;
    // Wall force while the probe moves inward: F = 800 * 0.0005 + 2 * 0.1
    const double force_N = -(0.4 + (steady ? 0.0 : 0.2)) - error_N;
    values[Signal::force_z_N] = static_cast<float>(force_N);
    values[Signal::force_N] = static_cast<float>(std::abs(force_N));
    values[Signal::encoder_2_counts] = steady ? 100.0f + static_cast<float>(i % 2) : 50.0f;
    values[Signal::position_z_m] = steady ? 0.0355f : 0.0350f;
    values[Signal::torque_1_Nm] = -0.001f;
    values[Signal::torque_3_Nm] = -0.08f;
  });
}

protocol::ParameterSet omni() {
  auto parameters = protocol::default_parameters();
  parameters[Parameter::wall_stiffness_N_per_m] = 800;
  parameters[Parameter::wall_damping_Ns_per_m] = 2;
  return parameters;
}

}  // namespace

TEST_CASE("the force law holds for a recording that was made by it") {
  const auto law = force_law_error(push(), omni());
  CHECK(law.samples == 12'000);
  CHECK(law.maximum_N < 1e-6);
  CHECK(law.samples_outside == 0);
}

TEST_CASE("a force that is off the law is found") {
  const auto small = force_law_error(push(0.004), omni());
  CHECK(small.maximum_N == doctest::Approx(0.004).scale(0).epsilon(1e-3));
  CHECK(small.samples_outside == 0);
  const auto large = force_law_error(push(0.02), omni());
  CHECK(large.samples_outside == 12'000);
  CHECK(large.maximum_relative == doctest::Approx(0.02 / 0.6).scale(0).epsilon(1e-3));
}

TEST_CASE("the law's force is limited as the firmware limits it, and never pulls") {
  auto parameters = omni();
  parameters[Parameter::force_limit_N] = 0.3f;
  CHECK(force_law_error(push(), parameters).maximum_N == doctest::Approx(0.3).epsilon(1e-3));
  const auto leaving = synthetic(10, [](std::size_t, protocol::SignalValues& values) {
    values[Signal::penetration_z_m] = -0.0005f;
    values[Signal::velocity_z_m_s] = -1.0f;  // out of the wall faster than the spring pushes
  });
  CHECK(force_law_error(leaving, omni()).maximum_N == 0);
}

TEST_CASE("the evaluation reads contact, largest values and the steady hold off the recording") {
  const auto result = evaluate(push(), omni(), {2, 1}, Interval{0.35, 0.85});
  CHECK(result.samples == 20'000);
  CHECK(result.samples_in_contact == 12'000);
  REQUIRE(result.contact);
  CHECK(result.contact->from_s == doctest::Approx(0.25));
  CHECK(result.contact->to_s == doctest::Approx(0.84995));
  CHECK(result.penetration_maximum_m == doctest::Approx(0.0005).scale(0));
  CHECK(result.force_maximum_N == doctest::Approx(0.6));
  CHECK(result.torque_1_maximum_Nm == doctest::Approx(0.001).scale(0));
  CHECK(result.other_torques_maximum_Nm == doctest::Approx(0.08));
  REQUIRE(result.steady_hold);
  CHECK(result.steady_hold->encoder_spread_counts[1] == doctest::Approx(1));
  CHECK(result.steady_hold->encoder_spread_counts[0] == 0);
}

TEST_CASE("without a plan the steadiest half second in the wall is taken") {
  const auto interval = find_steady_hold(push(), {2, 1});
  REQUIRE(interval);
  CHECK(interval->from_s >= 0.25);
  CHECK(interval->to_s <= 0.85);
  const auto nothing = synthetic(20'000, [](std::size_t, protocol::SignalValues&) {});
  CHECK_FALSE(find_steady_hold(nothing, {2, 1}));
  CHECK_FALSE(evaluate(nothing, omni(), {2, 1}, std::nullopt).contact);
}

TEST_CASE("the wall that was pushed is known by the deepest penetration") {
  CHECK(pushed_wall(push()) == BoxWall{2, 1});
  const auto to_the_left = synthetic(10, [](std::size_t i, protocol::SignalValues& values) {
    values[Signal::penetration_x_m] = i == 4 ? 0.0004f : 0.0f;
    values[Signal::penetration_y_m] = i == 7 ? -0.0003f : 0.0f;
  });
  CHECK(pushed_wall(to_the_left) == BoxWall{0, -1});
  CHECK_THROWS_AS(pushed_wall(synthetic(10, [](std::size_t, protocol::SignalValues&) {})), device::Error);
}

TEST_CASE("walls have names; the forward one lies in the arm's plane") {
  CHECK(parse_wall("y-") == BoxWall{1, -1});
  CHECK(wall_name({2, 1}) == "z+");
  for (const char* wrong : {"", "z", "w+", "z*", "z++"}) CHECK_THROWS_AS(parse_wall(wrong), device::Error);
  auto parameters = omni();
  parameters[Parameter::frame] = 1;
  CHECK(forward_wall(parameters) == BoxWall{2, 1});
  CHECK(side_wall(parameters) == BoxWall{0, 1});
  parameters[Parameter::frame] = 0;
  CHECK(forward_wall(parameters) == BoxWall{0, 1});
  CHECK(side_wall(parameters) == BoxWall{1, 1});
  CHECK(wall_position_m(parameters, {0, -1}) == static_cast<double>(parameters[Parameter::box_minimum_x_m]));
}

TEST_CASE("the summary names the simulation and contains the numbers of the result") {
  Circumstances circumstances;
  circumstances.about.simulation = true;
  circumstances.about.parameters = omni();
  circumstances.virtual_board = device::VirtualBoardOptions{.seed = 5};
  const auto result = evaluate(push(), omni(), {2, 1}, Interval{0.35, 0.85});
  const auto summary = summary_json(circumstances, result, {{0.5, 1e-4, 0.02, 0.001}, {0.5, 2e-4, 0.01, -0.003}});
  CHECK(summary.at("simulation") == true);
  CHECK(summary.at("seed") == 5);
  CHECK(summary.at("samples_lost") == 0);
  CHECK(summary.at("samples") == 20'000);
  CHECK(summary.at("parameters").at("force_limit_N") == 3.3);
  CHECK(summary.at("parameters").size() == protocol::parameter_count);
  CHECK(summary.at("steady_hold").at("encoder_spread_counts") == 1);
  CHECK(summary.at("steady_hold").at("duration_s").get<double>() == doctest::Approx(0.5));
  CHECK(summary.at("current_step").at("rise_time_s") == 2e-4);
  CHECK(summary.at("current_step").at("overshoot") == 0.02);
  CHECK(summary.at("current_step").at("steady_error_A") == -0.003);
}
