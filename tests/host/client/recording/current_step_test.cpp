// Tests the computed figures of current steps against known responses.
#include <doctest/doctest.h>

#include <cmath>

#include "host/client/device/error.hpp"
#include "host/client/recording/current_step.hpp"
#include "protocol/reports.hpp"

using namespace inkwell;
using recording::current_step;

namespace {

/// Returns a first-order response; the overshoot is added to the first sample of the plateau.
std::vector<float> answer(double amplitude_A, double time_constant_s, std::size_t begin, std::size_t end,
                          std::size_t size) {
  std::vector<float> current_A(size, 0.0f);
  for (std::size_t i = begin; i < end; ++i)
    current_A[i] = static_cast<float>(
        amplitude_A * (1 - std::exp(-static_cast<double>(i - begin) / protocol::servo_rate_Hz / time_constant_s)));
  return current_A;
}

std::vector<float> pulse(double amplitude_A, std::size_t begin, std::size_t end, std::size_t size) {
  std::vector<float> reference_A(size, 0.0f);
  for (std::size_t i = begin; i < end; ++i) reference_A[i] = static_cast<float>(amplitude_A);
  return reference_A;
}

}  // namespace

TEST_CASE("the rise time of a first-order answer is its time constant") {
  for (double amplitude_A : {0.5, -0.5}) {
    const auto step = current_step(pulse(amplitude_A, 100, 900, 1000), answer(amplitude_A, 0.2e-3, 100, 900, 1000));
    CHECK(step.amplitude_A == amplitude_A);
    CHECK(step.rise_time_s == doctest::Approx(0.2e-3).scale(0).epsilon(0.02));
    CHECK(step.overshoot == 0);
    CHECK(step.steady_error_A == doctest::Approx(0).epsilon(1e-6));
  }
}

TEST_CASE("overshoot and steady error of a current step are measured") {
  auto current_A = answer(0.5, 0.1e-3, 100, 900, 1000);
  current_A[140] = 0.55f;
  for (std::size_t i = 500; i < 900; ++i) current_A[i] = 0.48f;
  const auto step = current_step(pulse(0.5, 100, 900, 1000), current_A);
  CHECK(step.overshoot == doctest::Approx(0.1));
  CHECK(step.steady_error_A == doctest::Approx(-0.02));
}

TEST_CASE("a current that does not follow, or a missing pulse, is an error") {
  const std::vector<float> nothing(1000, 0.0f);
  CHECK_THROWS_AS(current_step(pulse(0.5, 100, 900, 1000), nothing), device::Error);
  CHECK_THROWS_AS(current_step(nothing, nothing), device::Error);
}
