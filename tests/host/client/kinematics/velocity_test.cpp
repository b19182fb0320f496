#include <doctest/doctest.h>

#include <cmath>

#include "host/client/kinematics/velocity.hpp"

namespace inkwell {

TEST_CASE("the velocity of a uniform motion is exact, however the poses are spaced") {
  kinematics::VelocityFit fit;
  CHECK(fit.velocity_m_s() == std::array<double, 3>{});
  double time_s = 100.0;
  for (int i = 0; i < 50; ++i) {
    time_s += i % 3 == 0 ? 0.002 : 0.001;
    fit.add(time_s, {0.3 * time_s, -0.1 * time_s, 0.02});
    if (i < 1) continue;
    CHECK(fit.velocity_m_s()[0] == doctest::Approx(0.3).epsilon(1e-6));
    CHECK(fit.velocity_m_s()[1] == doctest::Approx(-0.1).epsilon(1e-6));
    CHECK(std::abs(fit.velocity_m_s()[2]) < 1e-9);
  }
}

TEST_CASE("only the last 8 ms count") {
  kinematics::VelocityFit fit;
  for (int i = 0; i < 100; ++i) fit.add(1e-3 * i, {1e-3 * i, 0, 0});
  for (int i = 100; i < 109; ++i) fit.add(1e-3 * i, {0.1, 0, 0});
  CHECK(std::abs(fit.velocity_m_s()[0]) < 1e-9);
}

TEST_CASE("an encoder's steps are noise of a hundredth of a metre a second at most") {
  kinematics::VelocityFit fit;
  double largest_m_s = 0;
  for (int i = 0; i < 500; ++i) {
    fit.add(1e-3 * i, {i % 2 == 0 ? 0.0 : 3e-5, 0, 0});
    largest_m_s = std::max(largest_m_s, std::abs(fit.velocity_m_s()[0]));
    if (i == 20) largest_m_s = 0;
  }
  CHECK(largest_m_s < 0.01);
}

TEST_CASE("a velocity fit restarts after a gap or a decreasing time, and drops the oldest of too many poses") {
  kinematics::VelocityFit fit;
  for (int i = 0; i < 10; ++i) fit.add(1e-3 * i, {1e-3 * i, 0, 0});
  fit.add(1.0, {5, 0, 0});
  CHECK(fit.velocity_m_s()[0] == 0.0);
  fit.add(1.001, {5.001, 0, 0});
  CHECK(fit.velocity_m_s()[0] == doctest::Approx(1.0));
  fit.add(0.5, {7, 0, 0});
  CHECK(fit.velocity_m_s()[0] == 0.0);
  for (int i = 0; i < 100; ++i) fit.add(2.0 + 1e-5 * i, {2e-5 * i, 0, 0});
  CHECK(fit.velocity_m_s()[0] == doctest::Approx(2.0));
}

}  // namespace inkwell
