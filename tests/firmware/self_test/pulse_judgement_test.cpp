// Evaluation of the self-test pulses of healthy and defective motors.
#include <doctest/doctest.h>

#include <cmath>
#include <tuple>

#include "firmware/self_test/pulse_judgement.hpp"

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_motors.hpp"

namespace {

using namespace inkwell;
using link::PulseJudgement;
using protocol::SelfTestResult;
using Change = void (*)(tests::SimulatedMotor&);

struct Bench {
  tests::SimulatedMotors simulated;
  protocol::ParameterSet parameters = tests::confirmed_omni_parameters();
  float supply_V = board::supply_nominal_V;
  control::Triple counts_per_period{};

  PulseJudgement judgement() {
    const control::Settings settings = control::prepare(parameters);
    control::SelfTestPulses pulses;
    control::Triple requested_V{};
    pulses.start(control::PulseSize::of(settings.motor_model.resistance_ohm));
    for (float period = 0.0f; pulses.runs(); ++period) {
      std::array<std::int32_t, 3> counts{};
      for (std::size_t i = 0; i < 3; ++i) counts[i] = static_cast<std::int32_t>(period * counts_per_period[i]);
      requested_V =
          pulses.step(simulated.step(requested_V), counts,
                      {settings.motors.current_limit_A, supply_V, board::omni_driver.bridge_dead_time_part()});
    }
    return link::judge(pulses.round(), settings);
  }
};

/// Returns the result of pulses with a changed second motor. The first and the third motor must pass.
PulseJudgement with_second(Change change) {
  Bench bench;
  change(bench.simulated.motors[1]);
  const PulseJudgement judgement = bench.judgement();
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
    CHECK(judgement.motors[i].result == SelfTestResult::passed);
    CHECK(judgement.bridges[i].result == SelfTestResult::passed);
  }
  return judgement;
}

bool all_pass(const PulseJudgement& judgement) {
  bool pass = judgement.wires.result == SelfTestResult::passed;
  for (std::size_t i = 0; i < 3; ++i)
    pass = pass && judgement.motors[i].result == SelfTestResult::passed &&
           judgement.bridges[i].result == SelfTestResult::passed;
  return pass;
}

TEST_CASE("healthy motors pass with the right resistance, the right bridge loss and no current in other sensors") {
  Bench bench;
  const PulseJudgement judgement = bench.judgement();
  CHECK(all_pass(judgement));
  CHECK_FALSE(judgement.any(SelfTestResult::failed));
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(judgement.motors[i].figure == doctest::Approx(2.27).scale(0).epsilon(0.02));
    CHECK(judgement.bridges[i].figure == doctest::Approx(0.432).scale(0).epsilon(0.02));
    CHECK(judgement.bridge_loss_part[i] == doctest::Approx(0.024).scale(0).epsilon(0.02));
    CHECK(judgement.resistance_ohm[i] == doctest::Approx(2.26).epsilon(0.01));
  }
  CHECK(judgement.wires.figure < 0.01f);
}

TEST_CASE("a motor passes with 10 % less to 39 % more resistance, at any valid supply and with a sensor error of 3 %") {
  for (const float part : {0.9f, 1.0f, 1.39f})
    for (const float supply_V : {13.0f, 18.0f, 23.0f})
      for (const float gain : {0.97f, 1.03f}) {
        Bench bench;
        bench.supply_V = supply_V;
        for (auto& motor : bench.simulated.motors) {
          motor.resistance_ohm = 2.18f * part + 0.08f;
          motor.dead_V = board::omni_driver.bridge_dead_time_part() * supply_V;
          motor.sensor_gain = gain;
        }
        CAPTURE(part);
        CAPTURE(supply_V);
        CHECK(all_pass(bench.judgement()));
      }
}

TEST_CASE("a steady back EMF changes nothing, and one that a moving hand changes not enough") {
  for (const float back_emf_V : {-0.4f, 0.4f})
    for (const float per_s : {-20.0f, 0.0f, 20.0f}) {
      Bench bench;
      for (auto& motor : bench.simulated.motors) {
        motor.back_emf_V = back_emf_V;
        motor.back_emf_V_per_s = per_s;
      }
      const PulseJudgement judgement = bench.judgement();
      CAPTURE(judgement.motors[0].figure);
      CHECK_FALSE(judgement.any(SelfTestResult::failed));
    }
}

TEST_CASE("a resistance is kept if the motor rests and both signs agree") {
  Bench bench;
  const control::Settings settings = control::prepare(bench.parameters);
  const float back_emf_Vs_per_count = settings.motor_model.back_emf_Vs_per_rad[0] * settings.encoders.rad_per_count[0];
  const auto moving = [&](float mean_V) {
    bench.counts_per_period = {mean_V * protocol::servo_period_s / back_emf_Vs_per_count, 0.0f, 0.0f};
    const PulseJudgement judgement = bench.judgement();
    CHECK(judgement.motors[0].result == SelfTestResult::passed);
    return judgement.resistance_ohm[0];
  };
  CHECK(moving(0.05f) == doctest::Approx(2.26).epsilon(0.01));
  CHECK(moving(-0.05f) == doctest::Approx(2.26).epsilon(0.01));
  CHECK(moving(0.12f) == 0.0f);
  CHECK(moving(-0.12f) == 0.0f);
  bench.counts_per_period = {};
  for (const float back_emf_V : {0.2f, 0.75f}) {
    // If dead time and back EMF exceed the voltage of the low pulse, the voltage step depends on the direction.
    CAPTURE(back_emf_V);
    bench.simulated.motors[0].back_emf_V = back_emf_V;
    const PulseJudgement judgement = bench.judgement();
    const bool is_kept = judgement.resistance_ohm[0] != 0.0f;
    CHECK(is_kept == (back_emf_V == 0.2f));
  }
}

TEST_CASE("a half-shorted winding, a wrong sensor gain or an open motor fails the self-test item of the motor") {
  const auto failed = [](const PulseJudgement& judgement) {
    CHECK(judgement.bridges[1].result == SelfTestResult::not_done);
    return judgement.motors[1].result == SelfTestResult::failed;
  };
  for (const float heat : {0.92f, 1.0f, 1.39f}) {
    CAPTURE(heat);
    Bench shorted, doubled, halved;
    shorted.simulated.motors[1].resistance_ohm = 0.5f * 2.18f * heat + 0.08f;
    shorted.simulated.motors[1].inductance_H *= 0.25f;
    doubled.simulated.motors[1].resistance_ohm = halved.simulated.motors[1].resistance_ohm = 2.18f * heat + 0.08f;
    doubled.simulated.motors[1].sensor_gain = 2.0f;
    halved.simulated.motors[1].sensor_gain = 0.5f;
    for (Bench* bench : {&shorted, &doubled, &halved}) CHECK(failed(bench->judgement()));
  }
  const auto open = with_second([](auto& motor) { motor.is_open = true; });
  CHECK(failed(open));
  CHECK(open.motors[1].figure == doctest::Approx(PulseJudgement::missing_ohm));
  CHECK(with_second([](auto& motor) { motor.sensor_gain = -1.0f; }).motors[1].result == SelfTestResult::wrong_sign);
}

TEST_CASE("a motor with the right current in only one direction fails its self-test item") {
  Bench bench;
  // If a back EMF cancels the current of one direction, a half bridge appears not to conduct.
  bench.simulated.motors[0].back_emf_V = 2.0f;
  CHECK(bench.judgement().motors[0].result == SelfTestResult::failed);
  bench.simulated.motors[0].back_emf_V = -2.0f;
  CHECK(bench.judgement().motors[0].result == SelfTestResult::failed);
}

TEST_CASE("a doubled dead time fails the bridge item of the self-test, and this item does not disable the force") {
  const auto judgement = with_second([](auto& motor) { motor.dead_V *= 2.0f; });
  CHECK(judgement.motors[1].result == SelfTestResult::passed);
  CHECK(judgement.bridges[1].result == SelfTestResult::failed);
  CHECK(judgement.any(SelfTestResult::failed));
  CHECK(judgement.bridges[1].figure == doctest::Approx(0.864).epsilon(0.05));
  CHECK(judgement.bridge_loss_part[1] == 0.0f);
  CHECK_FALSE(info(protocol::SelfTestItem::bridge_2).takes_force);
}

TEST_CASE("the bridge loss is the measured value, both below and above the nominal value") {
  const auto half = with_second([](auto& motor) { motor.dead_V *= 0.5f; });
  CHECK(half.bridge_loss_part[1] == doctest::Approx(0.012).scale(0).epsilon(0.04));
  const auto more = with_second([](auto& motor) { motor.dead_V *= 1.5f; });
  CHECK(more.bridges[1].figure == doctest::Approx(0.648).scale(0).epsilon(0.04));
  CHECK(more.bridge_loss_part[1] == doctest::Approx(0.036).scale(0).epsilon(0.04));
}

TEST_CASE("a bridge with a negative loss from sensor errors has a loss of zero") {
  const auto judgement = with_second([](auto& motor) { motor.dead_V *= -0.2f; });
  CHECK(judgement.bridges[1].result == SelfTestResult::passed);
  CHECK(judgement.bridges[1].figure < -0.05f);
  CHECK(judgement.bridge_loss_part[1] == 0.0f);
}

TEST_CASE("swapped current wires fail the wires item of the self-test") {
  Bench swapped;
  std::swap(swapped.simulated.motors[0].sensor, swapped.simulated.motors[2].sensor);
  const auto found = swapped.judgement();
  CHECK(found.wires.result == SelfTestResult::failed);
  CHECK(found.motors[0].result == SelfTestResult::failed);
  CHECK(found.motors[1].result == SelfTestResult::passed);
  CHECK(found.wires.figure == doctest::Approx(0.67).epsilon(0.05));
}

TEST_CASE("if several current wires fail, the wires item reports the largest current") {
  Bench swapped;
  std::swap(swapped.simulated.motors[0].sensor, swapped.simulated.motors[1].sensor);
  swapped.simulated.motors[1].resistance_ohm *= 1.3f;
  const auto found = swapped.judgement();
  CHECK(found.wires.result == SelfTestResult::failed);
  CHECK(found.wires.figure == doctest::Approx(0.67).epsilon(0.05));
}

TEST_CASE("while the arm moves in either direction, a failure is reported as moved and not as failed") {
  for (const float counts_per_period : {0.2f, -0.2f}) {
    Bench bench;
    bench.simulated.motors[0].is_open = true;
    bench.counts_per_period = {counts_per_period, 0.0f, 0.0f};
    const auto found = bench.judgement();
    CHECK(found.motors[0].result == SelfTestResult::moved);
    CHECK(found.motors[1].result == SelfTestResult::passed);
    CHECK(found.any(SelfTestResult::moved));
    CHECK_FALSE(found.any(SelfTestResult::failed));
  }
  Bench slowly;
  slowly.simulated.motors[0].is_open = true;
  slowly.counts_per_period = {0.04f, 0.0f, 0.0f};
  CHECK(slowly.judgement().motors[0].result == SelfTestResult::failed);
}

TEST_CASE("the motion of a motor that is not confirmed is judged without its torque constant, which is not known") {
  using protocol::Parameter;
  for (const auto& [counts_per_period, torque_constant_Nm_per_A, result] :
       {std::tuple{0.1f, 0.001f, SelfTestResult::moved}, std::tuple{0.05f, 1.0f, SelfTestResult::failed}}) {
    Bench bench;
    bench.parameters[Parameter::motors_confirmed] = 0.0f;
    bench.parameters[Parameter::torque_constant_1_Nm_per_A] = torque_constant_Nm_per_A;
    bench.simulated.motors[0].resistance_ohm = 0.2f;
    bench.counts_per_period = {counts_per_period, 0.0f, 0.0f};
    CHECK(bench.judgement().motors[0].result == result);
  }
}

TEST_CASE("a motor without current limit takes no part") {
  Bench bench;
  bench.simulated.motors[2].is_open = true;
  bench.parameters[protocol::Parameter::current_limit_3_A] = 0.0f;
  const auto found = bench.judgement();
  CHECK(found.motors[2].result == SelfTestResult::no_part);
  CHECK(found.bridges[2].result == SelfTestResult::no_part);
  CHECK(found.wires.result == SelfTestResult::passed);
  CHECK_FALSE(found.any(SelfTestResult::failed));
}

}  // namespace
