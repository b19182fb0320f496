// Tests that the force along the motion is reduced before the speed reaches its limit.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/signal_path/speed_limit.hpp"

#include "tests/firmware/control/turning_arm.hpp"

namespace {

using namespace inkwell;
using control::Vector3;
using protocol::Limit;
using protocol::Parameter;
using protocol::Signal;
using tests::along;
using tests::TurningArm;

TEST_CASE("the driving force component is reduced above 0.8 of the speed limit and is zero above 0.9") {
  protocol::ParameterSet set = protocol::default_parameters();
  set[Parameter::speed_limit_m_per_s] = 2.0f;
  const control::SpeedLimit limit = control::prepare(set).speed;
  CHECK_FALSE(is_near(1.59f * 1.59f, limit));
  CHECK(is_near(1.61f * 1.61f, limit));
  CHECK(driving_reduction(1.59f * 1.59f, limit) == 0.0f);
  CHECK(driving_reduction(0.5f * (1.6f * 1.6f + 1.8f * 1.8f), limit) == doctest::Approx(0.5f));
  CHECK(driving_reduction(1.79f * 1.79f, limit) < 1.0f);
  CHECK(driving_reduction(1.81f * 1.81f, limit) == 1.0f);
  CHECK(driving_reduction(100.0f, limit) == 1.0f);
}

/// The waist joint turns for one second with a probe speed of up to 0.19 m/s. A 2 N force acts with or against the
/// motion.
struct FastArm : TurningArm {
  FastArm(float speed_limit_m_per_s, float force_N) {
    set[Parameter::speed_limit_m_per_s] = speed_limit_m_per_s;
    set[Parameter::power_given_W] = 20.0f;
    settings = control::prepare(set);
    turn(1.0f, [&](const Vector3& velocity_m_per_s) {
      const Vector3 force = three(Signal::force_x_N);
      const float speed_m_per_s = std::sqrt(dot(velocity_m_per_s, velocity_m_per_s));
      fastest_m_per_s = std::max(fastest_m_per_s, speed_m_per_s);
      const float along_N = speed_m_per_s > 0.01f ? dot(force, velocity_m_per_s) / speed_m_per_s : 0.0f;
      const float part = speed_m_per_s / speed_limit_m_per_s;
      // The force takes 1 ms to change, so speeds between 78 % and 92 % of the limit are not evaluated.
      if (part > 0.92f) at_fast_N = std::max(at_fast_N, std::fabs(along_N));
      if (part < 0.78f) at_slow_N = std::max(at_slow_N, std::fabs(along_N));
      return along(velocity_m_per_s, force_N);
    });
  }
  float fastest_m_per_s = 0.0f;
  float at_fast_N = 0.0f, at_slow_N = 0.0f;
};

TEST_CASE("near the speed limit, a program can no longer drive the arm, and the limit is reported") {
  const FastArm unbounded(10.0f, 2.0f);
  CHECK_FALSE(unbounded.reached(Limit::speed));
  const float limit_m_per_s = unbounded.fastest_m_per_s * 1.03f;
  const FastArm arm(limit_m_per_s, 2.0f);
  CHECK(arm.at_slow_N > 1.8f);
  CHECK(arm.at_fast_N < 0.1f);
  CHECK(arm.reached(Limit::speed));
  CHECK_FALSE(arm.reached(Limit::energy));
}

TEST_CASE("a program can brake an arm near the speed limit") {
  const float limit_m_per_s = FastArm(10.0f, 2.0f).fastest_m_per_s * 1.03f;
  const FastArm arm(limit_m_per_s, -2.0f);
  CHECK(arm.at_fast_N > 1.8f);
  CHECK_FALSE(arm.reached(Limit::speed));
}

}  // namespace
