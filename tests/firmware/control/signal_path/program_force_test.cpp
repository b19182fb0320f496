#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/signal_path/program_force.hpp"

namespace {

using namespace inkwell;
using control::ForceTarget;
using control::ProgramForce;
using control::ProgramForceLimits;
using control::Vector3;
using protocol::ForceMode;

constexpr float change_N_per_period = 0.05f;
constexpr ProgramForceLimits limits{.force_limit_N = 3.3f,
                                    .change_N_per_period = change_N_per_period,
                                    .periods_per_N = 1.0f / change_N_per_period,
                                    .expiry_periods = 1000};

ForceTarget target(const Vector3& force_N, std::uint32_t interval_periods = 20,
                   ForceMode mode = ForceMode::beside_walls) {
  return {force_N, mode, interval_periods, 1.0f / static_cast<float>(interval_periods)};
}

float length(const Vector3& vector) { return std::sqrt(control::dot(vector, vector)); }

TEST_CASE("the force is interpolated linearly between two reports") {
  ProgramForce program;
  program.set_target(target({0.4f, 0.0f, -0.2f}), limits);
  for (int period = 1; period <= 20; ++period) {
    program.advance(limits);
    CHECK(program.force_N.x == doctest::Approx(0.02f * static_cast<float>(period)).epsilon(1e-5));
    CHECK(program.force_N.z == doctest::Approx(-0.01f * static_cast<float>(period)).epsilon(1e-5));
  }
  // The force remains constant until the next report.
  for (int period = 0; period < 100; ++period) program.advance(limits);
  CHECK(program.force_N.x == doctest::Approx(0.4f).epsilon(1e-5));
  program.set_target(target({0.0f, 0.0f, -0.2f}, 40), limits);
  for (int period = 0; period < 20; ++period) program.advance(limits);
  CHECK(program.force_N.x == doctest::Approx(0.2f).epsilon(1e-5));
  CHECK(program.force_N.z == doctest::Approx(-0.2f).epsilon(1e-5));
}

TEST_CASE("a report beyond the limit keeps its direction") {
  ProgramForce program;
  program.set_target(target({300.0f, -400.0f, 0.0f}), limits);
  for (int period = 0; period < 200; ++period) program.advance(limits);
  CHECK(length(program.force_N) == doctest::Approx(3.3f).epsilon(0.02));
  CHECK(program.force_N.y / program.force_N.x == doctest::Approx(-4.0f / 3.0f).epsilon(1e-4));
}

TEST_CASE("the force never changes faster than its limit, and still reaches its target") {
  ProgramForce program;
  program.set_target(target({-3.0f, 0.0f, 0.0f}, 1), limits);
  for (int period = 0; period < 100; ++period) program.advance(limits);
  const Vector3 wanted[] = {{3.0f, 0.0f, 0.0f}, {0.0f, 3.0f, 0.0f}, {-1.0f, -1.0f, 2.0f}};
  for (const Vector3& force_N : wanted) {
    program.set_target(target(force_N, 1), limits);
    float fastest_N = 0.0f;
    for (int period = 0; period < 150; ++period) {
      const Vector3 before_N = program.force_N;
      program.advance(limits);
      fastest_N = std::max(fastest_N, length(program.force_N - before_N));
    }
    CHECK(fastest_N == doctest::Approx(change_N_per_period).scale(0).epsilon(1e-4));
    CHECK(program.force_N == force_N);
  }
}

TEST_CASE("without a new report the force remains until its expiry, and fades to zero within 10 ms without a jump") {
  ProgramForce program;
  program.set_target(target({2.0f, 0.0f, 0.0f}), limits);
  for (std::uint32_t period = 0; period < limits.expiry_periods; ++period) program.advance(limits);
  CHECK(program.force_N.x == doctest::Approx(2.0f).epsilon(1e-5));
  CHECK(!program.is_driven());
  float fastest_N = 0.0f;
  for (std::uint32_t period = 0; period < ProgramForce::fade_periods; ++period) {
    const float before_N = program.force_N.x;
    program.advance(limits);
    fastest_N = std::max(fastest_N, before_N - program.force_N.x);
  }
  CHECK(program.force_N == Vector3{});
  CHECK(fastest_N < 0.0101f);
}

TEST_CASE(
    "the force of a program that ends fades immediately, and a program that returns continues from the faded force") {
  ProgramForce program;
  program.set_target(target({2.0f, 0.0f, 0.0f}, 20, ForceMode::instead_of_walls), limits);
  for (int period = 0; period < 40; ++period) program.advance(limits);
  program.set_target(target({}, 20, ForceMode::none), limits);
  CHECK(!program.is_driven());
  for (int period = 0; period < 100; ++period) program.advance(limits);
  const float half_N = program.force_N.x;
  CHECK(half_N == doctest::Approx(1.0f).epsilon(1e-3));
  program.set_target(target({1.5f, 0.0f, 0.0f}), limits);
  program.advance(limits);
  CHECK(program.force_N.x == doctest::Approx(half_N + 0.025f).epsilon(1e-3));
}

TEST_CASE("a second end does not stretch the fading") {
  ProgramForce program;
  program.set_target(target({2.0f, 0.0f, 0.0f}), limits);
  for (int period = 0; period < 40; ++period) program.advance(limits);
  for (std::uint32_t period = 0; period < ProgramForce::fade_periods; ++period) {
    program.set_target(target({}, 20, ForceMode::none), limits);
    program.advance(limits);
  }
  CHECK(program.force_N == Vector3{});
}

TEST_CASE("late is more than a millisecond after the interval that the program named") {
  ProgramForce program;
  CHECK(!program.set_target(target({}), limits));
  const auto next_after = [&](int periods) {
    for (int period = 0; period < periods; ++period) program.advance(limits);
    return program.set_target(target({}), limits);
  };
  CHECK(!next_after(20));
  CHECK(!next_after(40));
  CHECK(next_after(41));
  // The time after an expired program force does not count as a delay.
  CHECK(!next_after(3000));
}

}  // namespace
