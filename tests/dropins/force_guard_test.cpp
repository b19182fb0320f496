#include <doctest/doctest.h>

#include "host/bindings/dropins/force_guard.hpp"

namespace inkwell::dropins {
namespace {

constexpr ForceLimits limits{.maximum_N = 3,
                             .speed_m_per_s = 1.2,
                             .change_N_per_ms = 4,
                             .ramp_N_per_s = 10,
                             .clamps = true,
                             .ramps = true,
                             .limits_force = true,
                             .limits_speed = true,
                             .limits_change = true};

struct Course {
  ForceGuard guard;
  ForceLimits limits_now = limits;
  double time_s = 1.0;
  ForceGuard::Answer step(const Vector& force_N, double speed_m_per_s = 0, bool is_on = true, double passed_s = 0.001) {
    time_s += passed_s;
    return guard.step({force_N, speed_m_per_s, time_s, is_on}, limits_now);
  }
  /// Returns the force after `milliseconds` steps with a constant input.
  double after(int milliseconds, const Vector& force_N) {
    for (int i = 1; i < milliseconds; ++i) step(force_N);
    return length(step(force_N).force_N);
  }
};

TEST_CASE("a force rises along its ramp, retains its direction, and stops at the maximum") {
  Course course;
  course.step({});
  const auto early = course.step({0, 30, 40}).force_N;
  CHECK(early[1] / early[2] == doctest::Approx(0.75));
  CHECK(length(early) < 0.6);
  CHECK(course.after(50, {0, 30, 40}) < 1.2);
  CHECK(course.after(400, {0, 30, 40}) == doctest::Approx(3.0));
}

TEST_CASE("frames that see the same pose change the force together no more than one does") {
  Course course;
  course.limits_now.ramps = false;
  course.limits_now.change_N_per_ms = 0.5;
  course.step({});
  CHECK(length(course.step({3, 0, 0}).force_N) == doctest::Approx(0.5));
  for (int i = 0; i < 9; ++i) CHECK(length(course.step({3, 0, 0}, 0, true, 0.0).force_N) == doctest::Approx(0.5));
  CHECK(length(course.step({3, 0, 0}).force_N) == doctest::Approx(1.0));
}

TEST_CASE("without clamping, a force above the limit is dropped with an error, and the next force ramps up") {
  Course course;
  course.limits_now.clamps = false;
  course.after(400, {1, 0, 0});
  const auto dropped = course.step({4, 0, 0});
  CHECK(dropped.error == exceeded_max_force);
  CHECK(length(dropped.force_N) == 0.0);
  CHECK(course.after(20, {1, 0, 0}) < 0.3);
  CHECK(course.after(100, {1, 0, 0}) == doctest::Approx(1.0));
  course.limits_now.limits_force = false;
  CHECK(course.step({4, 0, 0}).error == success);
}

TEST_CASE("a stylus that is too fast loses the force, unless the limit is switched off") {
  Course course;
  course.after(400, {1, 0, 0});
  const auto fast = course.step({1, 0, 0}, 1.3);
  CHECK(fast.error == exceeded_max_velocity);
  CHECK(length(fast.force_N) == 0.0);
  course.limits_now.limits_speed = false;
  CHECK(course.step({1, 0, 0}, 1.3).error == success);
}

TEST_CASE("a change is stretched in time, a pause and a force that was off begin at nothing") {
  Course course;
  course.limits_now.change_N_per_ms = 0.1;
  course.limits_now.ramps = false;
  course.after(20, {1, 0, 0});
  CHECK(course.step({-1, 0, 0}).force_N[0] == doctest::Approx(0.9));
  course.limits_now = limits;
  course.after(400, {1, 0, 0});
  CHECK(length(course.step({1, 0, 0}, 0, true, 0.2).force_N) < 0.6);
  course.after(400, {1, 0, 0});
  CHECK(length(course.step({1, 0, 0}, 0, false).force_N) == 0.0);
  CHECK(course.after(10, {1, 0, 0}) < 0.2);
}

}  // namespace
}  // namespace inkwell::dropins
