// Tests a force law in the controller: activation, restart, and a force that is not a number.
#include <doctest/doctest.h>

#include <limits>

#include "firmware/control/signal_path/felt_force_law.hpp"
#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace {

using namespace inkwell;
using control::Controller;
using control::Samples;
using control::Settings;
using protocol::Command;
using protocol::Fault;
using protocol::ForceMode;
using protocol::Signal;
using protocol::State;

/// The law's force of 0.5 N points up and has no ramp.
Settings settings_with_law() {
  protocol::ParameterSet set = tests::without_motors(tests::paper_parameters());
  set[protocol::Parameter::force_ramp_s] = 0.0f;
  Settings settings = control::prepare(set);
  settings.force_law = {0.5f, 1.0f};
  return settings;
}

constexpr std::size_t dividend = 0, divisor = 1;
constexpr std::size_t periods_signal = protocol::signal_count, switches_signal = periods_signal + 1;

struct LawRig {
  Settings settings = settings_with_law();
  Controller controller = tests::active_controller(settings);
  Samples samples = tests::samples_at_rest();

  void run(std::uint32_t periods) {
    for (std::uint32_t i = 0; i < periods; ++i) {
      controller.host_alive();
      tests::run(controller, samples, settings, 1);
    }
  }
  void enable() {
    controller.carry_out(tests::command(Command::enable_force));
    run(1);
    REQUIRE(protocol::force_is_on(controller.state()));
  }
  float law_periods() const { return controller.signals().values[periods_signal]; }
  float law_switches() const { return controller.signals().values[switches_signal]; }
  float force_z_N() const { return controller.signals().values[static_cast<std::size_t>(Signal::force_x_N) + 2]; }
};

TEST_CASE("the period count of a law starts at zero and restarts at zero after a reset") {
  control::FeltForceLaw law;
  control::Probe probe;
  for (int round = 0; round < 2; ++round) {
    for (std::uint32_t period = 0; period < 3; ++period) {
      probe.periods = 77;
      CHECK(law.force_N(probe, {0.5f, 1.0f}).z == 0.5f);
      CHECK(probe.periods == period);
      CHECK(law.signal(0) == static_cast<float>(period));
    }
    law.reset();
    CHECK(law.signal(0) == 0.0f);
  }
}

TEST_CASE("a law acts only while the force is on, and restarts with each switch-on") {
  LawRig rig;
  rig.run(100);
  CHECK(rig.force_z_N() == 0.5f);
  CHECK(rig.law_periods() == 99.0f);
  rig.controller.carry_out(tests::command(Command::stop));
  rig.run(10);
  CHECK(rig.force_z_N() == 0.0f);
  CHECK(rig.law_periods() == 0.0f);
  rig.enable();
  rig.run(5);
  CHECK(rig.law_periods() == 4.0f);
}

TEST_CASE("a law receives the debounced states of the switches") {
  LawRig rig;
  rig.run(1);
  CHECK(rig.law_switches() == 0.0f);
  for (const auto which : {protocol::Switch::button_1, protocol::Switch::button_2}) {
    rig.samples.switches = static_cast<std::uint8_t>(which);
    rig.run(1);
    CHECK(rig.law_switches() == 0.0f);
    rig.run(control::SwitchFilter::settle_periods + control::SwitchFilter::count);
    CHECK(rig.law_switches() == static_cast<float>(which));
    rig.samples.switches = 0;
    rig.run(control::SwitchFilter::settle_periods + control::SwitchFilter::count);
    CHECK(rig.law_switches() == 0.0f);
  }
}

TEST_CASE("a law rests while a program's force stands instead of it") {
  LawRig rig;
  rig.run(100);
  control::ForceTarget target{};
  target.mode = ForceMode::instead_of_walls;
  rig.controller.drive(target, rig.settings);
  rig.run(10);
  CHECK(rig.law_periods() == 0.0f);
  target.mode = ForceMode::beside_walls;
  rig.controller.drive(target, rig.settings);
  rig.run(5);
  CHECK(rig.law_periods() == 4.0f);
}

TEST_CASE("a force that is infinite or no number is not felt, and the fault is the law's") {
  for (const float dividend_N : {0.5f, 0.0f, std::numeric_limits<float>::max()}) {
    LawRig rig;
    rig.run(10);
    rig.settings.force_law[dividend] = dividend_N;
    // The largest float is finite, but its square is infinite, so the direction of the force is undefined.
    rig.settings.force_law[divisor] = dividend_N > 1.0f ? 1.0f : 0.0f;
    rig.run(1);
    CHECK(rig.controller.state() == State::fault);
    CHECK(rig.controller.fault() == Fault::force_law);
    CHECK(rig.force_z_N() <= 0.5f);  // the previous force, or a decreasing force
    CHECK_FALSE(rig.controller.force_is_on());
    rig.run(1);
    CHECK(rig.force_z_N() == 0.0f);
  }
}

}  // namespace
