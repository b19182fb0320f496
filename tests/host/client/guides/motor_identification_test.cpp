#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host/client/device/error.hpp"
#include "host/client/guides/motor_identification.hpp"

using namespace inkwell;
using guides::VoltagePulse;

namespace {

constexpr double period_s = 50e-6, ripple_A = 0.08;

struct Motor {
  double resistance_ohm, inductance_H, dead_time_V = 0.43, back_emf_V_at_end = 0;
};

/// Exact response of a motor in steps of 1/100 control period. The samples have 2 mA noise and 2 mA resolution, as on
/// the board.
VoltagePulse pulse_of(const Motor& motor, double voltage_V, std::mt19937& random, double delay_s = period_s) {
  std::normal_distribution<double> noise(0, 0.002);
  constexpr int before = 20, on = 200, after = 40, fine = 100;
  VoltagePulse pulse;
  double current_A = 0;
  for (int k = 0; k < before + on + after; ++k) {
    const bool is_on = k >= before && k < before + on;
    const double emf_V = motor.back_emf_V_at_end * std::max(0, std::min(k - before, on)) / on;
    pulse.voltage_V.push_back(is_on ? voltage_V : 0.0);
    pulse.current_A.push_back(0.002 * std::round((current_A + noise(random)) / 0.002));
    pulse.back_emf_V.push_back(emf_V);
    for (int i = 0; i < fine; ++i) {
      const double time_s = (k - before) * period_s + i * period_s / fine - delay_s;
      const double acting_V = time_s >= 0 && time_s < on * period_s ? voltage_V : 0.0;
      const double lost_V = motor.dead_time_V * std::clamp(current_A / ripple_A, -1.0, 1.0);
      current_A +=
          period_s / fine * (acting_V - emf_V - lost_V - motor.resistance_ohm * current_A) / motor.inductance_H;
    }
  }
  return pulse;
}

std::vector<VoltagePulse> pulses_of(const Motor& motor, std::uint32_t seed, double delay_s = period_s) {
  std::mt19937 random(seed);
  std::vector<VoltagePulse> pulses;
  for (const double voltage_V : {1.0, -1.0, 2.5, -2.5, 2.5, -2.5}) {
    Motor moving = motor;
    moving.back_emf_V_at_end = std::copysign(motor.back_emf_V_at_end, voltage_V);
    pulses.push_back(pulse_of(moving, voltage_V, random, delay_s));
  }
  return pulses;
}

}  // namespace

TEST_CASE("resistance and inductance are found through noise, dead time and back-EMF") {
  for (const Motor& motor : {Motor{2.26, 0.238e-3}, Motor{0.9, 0.15e-3, 0.3}, Motor{8.0, 2.0e-3, 0.43, 0.2},
                             Motor{2.26, 0.238e-3, 0.43, 0.3}})
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const auto found = guides::identify(pulses_of(motor, seed), period_s, ripple_A);
      INFO("R ", motor.resistance_ohm, " L ", motor.inductance_H, " seed ", seed);
      CHECK(found.resistance_ohm == doctest::Approx(motor.resistance_ohm).scale(0).epsilon(0.01));
      CHECK(found.inductance_H == doctest::Approx(motor.inductance_H).scale(0).epsilon(0.03));
      CHECK(found.dead_time_voltage_V == doctest::Approx(motor.dead_time_V).scale(0).epsilon(0.05));
      CHECK(found.residual_A < 0.005);
    }
}

TEST_CASE("the motor identification separates the delay from the inductance") {
  const Motor motor{2.26, 0.238e-3, 0.0};
  for (const double delay_s : {0.5 * period_s, period_s, 1.5 * period_s}) {
    const auto found = guides::identify(pulses_of(motor, 3, delay_s), period_s, ripple_A);
    CHECK(found.inductance_H == doctest::Approx(motor.inductance_H).scale(0).epsilon(0.03));
    CHECK(std::abs(found.delay_s - delay_s) < 3e-6);
  }
}

TEST_CASE("an unplugged motor, no pulse and nonsense are named") {
  std::mt19937 random(1);
  VoltagePulse open = pulse_of({2.26, 0.238e-3}, 2.0, random);
  for (double& current_A : open.current_A) current_A = 0;
  CHECK_THROWS_WITH_AS(guides::identify({open}, period_s, ripple_A), doctest::Contains("No current flows"),
                       device::Error);
  VoltagePulse silent = open;
  for (double& voltage_V : silent.voltage_V) voltage_V = 0;
  CHECK_THROWS_WITH_AS(guides::identify({silent}, period_s, ripple_A), doctest::Contains("did not reach"),
                       device::Error);
  VoltagePulse wild = pulse_of({2.26, 0.238e-3}, 2.0, random);
  for (std::size_t i = 0; i < wild.current_A.size(); ++i) wild.current_A[i] += i % 3 == 0 ? 1.5 : 0.0;
  CHECK_THROWS_AS(guides::identify({wild}, period_s, ripple_A), device::Error);
  VoltagePulse reversed = pulse_of({2.26, 0.238e-3}, 2.0, random);
  for (double& current_A : reversed.current_A) current_A = -current_A;
  CHECK_THROWS_WITH_AS(guides::identify({reversed}, period_s, ripple_A), doctest::Contains("has the wrong sign"),
                       device::Error);
  CHECK_THROWS_AS(guides::identify({}, period_s, ripple_A), device::Error);
}

TEST_CASE("gains cancel the winding's pole") {
  const auto gains = guides::suggest_gains({2.18, 0.238e-3}, 800);
  CHECK(gains.proportional_V_per_A == doctest::Approx(1.196).epsilon(0.001));
  CHECK(gains.integral_V_per_As == doctest::Approx(10958).epsilon(0.001));
  CHECK(gains.integral_V_per_As / gains.proportional_V_per_A == doctest::Approx(2.18 / 0.238e-3));
  CHECK(guides::phase_margin_deg(800, 75e-6) == doctest::Approx(68.4));
}
