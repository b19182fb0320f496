// Tests the guides: consent before any motion, cancellation, a disconnected device, and applying the results.
#include <doctest/doctest.h>

#include <algorithm>

#include "boards/known/boards.hpp"
#include "host/client/device/fault_text.hpp"
#include "host/client/guides/guides.hpp"

#include "tests/host/client/guides/fake_arm.hpp"

using namespace inkwell;
using guides::Guide;
using guides::Phase;
using protocol::Command;
using protocol::Parameter;
using tests::FakeArm;

namespace {

bool no_current_was_asked(const FakeArm& arm) { return arm.pulses.empty(); }

/// Checks that the last requests switched the force and the pulses off.
void check_left_safe(const FakeArm& arm) {
  REQUIRE(!arm.commands.empty());
  CHECK(arm.commands.back() == Command::disable_force);
  CHECK(arm.selected.empty());
}

void run_to_step(FakeArm& arm, Guide& guide, std::size_t step) {
  for (int ms = 0; ms < 20'000 && guide.step_index() < step && !guide.is_over(); ++ms) {
    if (guide.phase() == Phase::awaits_consent) guide.confirm();
    arm.pass_millisecond(guide);
  }
  REQUIRE(guide.step_index() == step);
}

guides::CurrentLoopOptions one_motor(double bandwidth_Hz = 600) { return {{2}, bandwidth_Hz}; }
constexpr std::size_t identify_step = 1, trial_step = 3;  // after the inkwell; after the first step response

void run_into_trial(FakeArm& arm, Guide& guide) {
  run_to_step(arm, guide, trial_step);
  guide.confirm();
  arm.pass_millisecond(guide);
  arm.pass_millisecond(guide);
}

}  // namespace

TEST_CASE("a guide applies no current before the user agrees, and its text states the current pulses") {
  FakeArm arm;
  Guide guide = guides::current_loop_guide.start({.current_loop = one_motor()});
  for (int ms = 0; ms < 2000; ++ms) arm.pass_millisecond(guide);
  CHECK(guide.phase() == Phase::awaits_consent);
  CHECK(guide.step_index() == identify_step);
  CHECK(no_current_was_asked(arm));
  CHECK(arm.transactions.empty());
  CHECK(guide.step().text().find("Motor 2 receives 8 pulses of 10 ms") != std::string::npos);
}

TEST_CASE("current-loop tuning identifies, tries, puts back and applies in one transaction") {
  FakeArm arm;
  arm.winding = {3.0, 0.4e-3};
  Guide guide = guides::current_loop_guide.start({.current_loop = one_motor()});
  arm.run(guide, true);
  INFO(guide.outcome());
  REQUIRE(guide.phase() == Phase::finished);
  check_left_safe(arm);
  const auto& details = guide.findings().details;
  CHECK(details["motors"][0]["circuit_resistance_ohm"].get<double>() == doctest::Approx(3.0).epsilon(0.01));
  CHECK(details["motors"][0]["inductance_H"].get<double>() == doctest::Approx(0.4e-3).scale(0).epsilon(0.02));

  // The guide applied the values in one transaction and restored the previous values in a second transaction.
  REQUIRE(arm.transactions.size() == 2);
  CHECK(arm.parameters() == protocol::default_parameters());
  REQUIRE(guide.findings().proposals.size() == 3);
  CHECK(guide.findings().proposals[2].parameter == Parameter::motor_resistance_2_ohm);
  CHECK(guide.findings().proposals[2].proposed == doctest::Approx(3.0 - board::omni_driver.shunt_ohm).epsilon(0.01));
  CHECK(guide.findings().proposals[0].proposed ==
        doctest::Approx(0.4e-3 * 2 * 3.14159265 * 600).scale(0).epsilon(0.02));
  CHECK(guide.findings().curves.size() == 2);

  guide.apply(arm);
  arm.pass_millisecond(guide);
  CHECK(guide.applied() == guides::Applied::yes);
  REQUIRE(arm.transactions.size() == 3);
  CHECK(arm.transactions.back().size() == 3);
  CHECK(arm.parameters()[Parameter::current_proportional_gain_V_per_A] == guide.findings().proposals[0].proposed);
}

TEST_CASE("the shunt is that of the board that is there; of an unknown board no resistance is proposed") {
  FakeArm arm;
  arm.winding = {3.0, 0.4e-3};
  std::string sentence;
  bool is_known = false;
  SUBCASE("another one that is known") {
    arm.board_name() = board::bench_modules.name;
    is_known = true;
  }
  SUBCASE("one that is not") {
    arm.board_name() = "feather";
    sentence = "This companion does not know the board feather, but bench_modules, omni_driver";
  }
  SUBCASE("the firmware does not report its board") {
    arm.board_name() = "";
    sentence = "The firmware does not report its board";
  }
  Guide guide = guides::current_loop_guide.start({.current_loop = one_motor()});
  arm.run(guide, true);
  INFO(guide.outcome());
  REQUIRE(guide.phase() == Phase::finished);
  const auto& findings = guide.findings();
  const auto& motor = findings.details["motors"][0];
  REQUIRE(findings.proposals.size() == (is_known ? 3 : 2));
  CHECK(findings.proposals[0].parameter == Parameter::current_proportional_gain_V_per_A);
  if (is_known) {
    const double without_shunt_ohm =
        motor["circuit_resistance_ohm"].get<double>() - static_cast<double>(board::bench_modules.shunt_ohm);
    CHECK(motor["resistance_ohm"].get<double>() == doctest::Approx(without_shunt_ohm).epsilon(1e-6));
    CHECK(findings.proposals[2].proposed == doctest::Approx(without_shunt_ohm).epsilon(1e-3));
  } else {
    CHECK(motor["resistance_ohm"].is_null());
    CHECK(std::ranges::any_of(findings.sentences, [&](const auto& said) { return said.starts_with(sentence); }));
  }
}

TEST_CASE("a refused proposal reports the refusal text of the device") {
  FakeArm arm;
  Guide guide = guides::current_loop_guide.start({.current_loop = one_motor()});
  arm.run(guide, true);
  REQUIRE(guide.phase() == Phase::finished);
  arm.pass_millisecond(guide);
  arm.refuses = true;
  guide.apply(arm);
  arm.pass_millisecond(guide);
  CHECK(guide.applied() == guides::Applied::refused);
  CHECK(guide.refusal() == "The device refused it.");
}

TEST_CASE("cancel ends a pulse immediately") {
  FakeArm arm;
  Guide guide = guides::current_loop_guide.start({.current_loop = one_motor()});
  arm.run(guide, false);
  guide.confirm();
  for (int ms = 0; ms < 500 && !arm.current_flows(); ++ms) arm.pass_millisecond(guide);
  REQUIRE(arm.current_flows());
  guide.cancel(arm);
  CHECK(guide.phase() == Phase::cancelled);
  check_left_safe(arm);
  for (int ms = 0; ms < 3; ++ms) arm.pass_millisecond(guide);
  CHECK_FALSE(arm.current_flows());
  CHECK(arm.transactions.empty());
}

TEST_CASE("cancel in the trial puts the old gains back") {
  FakeArm arm;
  Guide guide = guides::current_loop_guide.start({.current_loop = one_motor()});
  run_into_trial(arm, guide);
  REQUIRE(arm.parameters() != protocol::default_parameters());
  guide.cancel(arm);
  arm.pass_millisecond(guide);
  CHECK(arm.parameters() == protocol::default_parameters());
  CHECK(guide.at_rest());
  guide.apply(arm);  // a canceled guide has nothing to apply
  CHECK(arm.parameters() == protocol::default_parameters());
}

TEST_CASE("a disconnected device ends the guide with a sentence, and the trial parameters must be restored") {
  FakeArm arm;
  Guide guide = guides::current_loop_guide.start({.current_loop = one_motor()});
  run_into_trial(arm, guide);
  arm.unplug();
  arm.pass_millisecond(guide);
  REQUIRE(guide.phase() == Phase::failed);
  CHECK(guide.outcome().find("was disconnected in the step \"Step response with the suggested gains\"") !=
        std::string::npos);
  CHECK(guide.outcome().find("trial parameters") != std::string::npos);
  CHECK(guide.outcome().find("Connect the device again") != std::string::npos);
  REQUIRE(arm.transactions.size() == 2);  // queued until the reconnection
  CHECK(arm.transactions[1][0].second == protocol::default_parameters()[Parameter::current_proportional_gain_V_per_A]);
}

TEST_CASE("every guide tolerates a disconnection at any time") {
  for (const int after_ms : {0, 1, 50, 230, 300, 420, 700}) {
    FakeArm arm;
    Guide guide = guides::current_loop_guide.start({.current_loop = one_motor()});
    for (int ms = 0; ms < after_ms; ++ms) {
      if (guide.phase() == Phase::awaits_consent) guide.confirm();
      arm.pass_millisecond(guide);
    }
    const bool had_begun = after_ms > 0 && !guide.is_over();
    arm.unplug();
    for (int ms = 0; ms < 5; ++ms) arm.pass_millisecond(guide);
    if (had_begun) CHECK(guide.phase() == Phase::failed);
    if (after_ms == 0) CHECK(guide.phase() == Phase::working);  // still waits for the connection
  }
}

TEST_CASE("a fault ends the guide with its cause and remedy") {
  FakeArm arm;
  Guide guide = guides::connection_guide.start();
  arm.pass_millisecond(guide);
  arm.pose().state = protocol::State::fault;
  arm.pose().fault = protocol::Fault::supply_low;
  arm.pass_millisecond(guide);
  REQUIRE(guide.phase() == Phase::failed);
  CHECK(guide.outcome().find("supply_low") != std::string::npos);
  CHECK(guide.outcome().find(device::fault_text(protocol::Fault::supply_low).remedy) != std::string::npos);
}

TEST_CASE("a guide fails if scope samples were lost") {
  FakeArm arm;
  arm.loses_scope = true;
  Guide guide = guides::current_loop_guide.start({.current_loop = one_motor()});
  arm.run(guide, true);
  REQUIRE(guide.phase() == Phase::failed);
  CHECK(guide.outcome().find("were lost") != std::string::npos);
}

TEST_CASE("encoders that count down and motors that turn backward are found") {
  for (const bool encoder_wrong : {false, true})
    for (const bool motor_wrong : {false, true}) {
      FakeArm arm;
      // If both signs are wrong, motor and encoder agree.
      arm.motor_turns_backward = motor_wrong != encoder_wrong;
      Guide guide = guides::directions_guide.start();
      for (int ms = 0; ms < 20'000 && !guide.is_over(); ++ms) {
        const auto task = guide.step().user_task();
        if (guide.phase() == Phase::awaits_consent) guide.confirm();
        if (task.kind == guides::UserTask::Kind::turn_joint_forward)
          arm.pose().joint_rad[task.number - 1] += (encoder_wrong ? -1.0f : 1.0f) * 0.002f;
        if (task.kind == guides::UserTask::Kind::hold_loosely) arm.pose().switches = 0;
        arm.pass_millisecond(guide);
      }
      INFO(guide.outcome(), " encoder ", encoder_wrong, " motor ", motor_wrong);
      REQUIRE(guide.phase() == Phase::finished);
      const auto proposes = [&](Parameter parameter) {
        return std::ranges::any_of(guide.findings().proposals,
                                   [&](const auto& p) { return p.parameter == parameter && p.proposed == 1.0f; });
      };
      CHECK(proposes(Parameter::encoder_1_reversed) == encoder_wrong);
      CHECK(proposes(Parameter::encoder_3_reversed) == encoder_wrong);
      CHECK(proposes(Parameter::motor_2_reversed) == motor_wrong);
      CHECK(guide.findings().proposals.size() == (encoder_wrong ? 3u : 0u) + (motor_wrong ? 3u : 0u));
      check_left_safe(arm);
    }
}

TEST_CASE("the directions guide fails with a message if a joint does not turn with its motor") {
  FakeArm arm;
  arm.motor_is_stuck = true;
  Guide guide = guides::directions_guide.start();
  for (int ms = 0; ms < 20'000 && !guide.is_over(); ++ms) {
    const auto task = guide.step().user_task();
    if (guide.phase() == Phase::awaits_consent) guide.confirm();
    if (task.kind == guides::UserTask::Kind::turn_joint_forward) arm.pose().joint_rad[task.number - 1] += 0.002f;
    if (task.kind == guides::UserTask::Kind::hold_loosely) arm.pose().switches = 0;
    arm.pass_millisecond(guide);
  }
  REQUIRE(guide.phase() == Phase::failed);
  CHECK(guide.outcome().find("Joint 1 did not turn") != std::string::npos);
}

TEST_CASE(
    "joint stops require both ends of a joint before the button counts, and the trust option selects the proposal") {
  for (const auto trust : {guides::StopsTrust::limits, guides::StopsTrust::encoders}) {
    FakeArm arm;
    Guide guide = guides::stops_guide.start({.trust = trust});
    const auto rest = [&](int joint, float angle_rad) {
      arm.pose().joint_rad[joint - 1] = angle_rad;
      for (int ms = 0; ms < 400; ++ms) arm.pass_millisecond(guide);
    };
    for (int ms = 0; ms < 300; ++ms) arm.pass_millisecond(guide);
    REQUIRE(guide.step_index() == 1);
    // Encoder 1 reports half of the true travel.
    rest(1, -0.49f);
    guide.confirm();
    for (int ms = 0; ms < 10; ++ms) arm.pass_millisecond(guide);
    CHECK(guide.step_index() == 1);  // one of two stops is known
    rest(1, 0.49f);
    guide.confirm();
    // Joint 2 is correct. The stops of joint 3 are 0.2 rad above the limits while joint 2 is at 1.0 rad.
    rest(2, 0.0f);
    rest(2, 1.75f);
    guide.confirm();
    arm.pose().joint_rad[2] = 1.0f;
    rest(2, 1.0f);
    rest(3, 1.0f - 0.81f + 0.2f);
    rest(3, 1.0f + 1.25f + 0.2f);
    guide.confirm();
    for (int ms = 0; ms < 10; ++ms) arm.pass_millisecond(guide);
    INFO(guide.outcome());
    REQUIRE(guide.phase() == Phase::finished);
    CHECK(no_current_was_asked(arm));
    const auto proposed = [&](Parameter parameter) -> std::optional<float> {
      for (const auto& p : guide.findings().proposals)
        if (p.parameter == parameter) return p.proposed;
      return std::nullopt;
    };
    if (trust == guides::StopsTrust::limits) {
      CHECK(proposed(Parameter::encoder_1_counts_per_turn) == 720.0f);
      REQUIRE(proposed(Parameter::inkwell_joint_3_rad).has_value());
      CHECK(*proposed(Parameter::inkwell_joint_3_rad) == doctest::Approx(0.10 - 0.2));
      CHECK(guide.findings().proposals.size() == 2);
    } else {
      CHECK(*proposed(Parameter::joint_1_minimum_rad) == doctest::Approx(-0.49));
      CHECK(*proposed(Parameter::joint_1_maximum_rad) == doctest::Approx(0.49));
      CHECK(*proposed(Parameter::elbow_minimum_rad) == doctest::Approx(-0.61));
      CHECK(*proposed(Parameter::elbow_maximum_rad) == doctest::Approx(1.45));
      CHECK(guide.findings().proposals.size() == 4);
    }
  }
}

TEST_CASE("potentiometers are fitted between the stops that are given") {
  FakeArm arm;
  guides::PotentiometerOptions options;
  options.range[0] = guides::AngleRange{-2.0, 2.0};
  Guide guide = guides::potentiometer_guide.start({.potentiometers = options});
  const auto hold = [&](int axis, double ratio) {
    const double slope = arm.parameters()[of_number(Parameter::gimbal_1_slope_rad, axis)];
    const double offset = arm.parameters()[of_number(Parameter::gimbal_1_offset_rad, axis)];
    arm.pose().gimbal_rad[axis - 1] = static_cast<float>(slope * ratio + offset);
    for (int ms = 0; ms < 60; ++ms) arm.pass_millisecond(guide);
  };
  for (int axis = 1; axis <= 3; ++axis) {
    hold(axis, axis == 1 ? 0.1 : 0.0);
    hold(axis, axis == 1 ? 0.9 : 1.0);
    guide.confirm();
    arm.pass_millisecond(guide);
  }
  arm.pass_millisecond(guide);
  INFO(guide.outcome());
  REQUIRE(guide.phase() == Phase::finished);
  REQUIRE(guide.findings().proposals.size() == 2);  // the other axes are correct
  CHECK(guide.findings().proposals[0].parameter == Parameter::gimbal_1_slope_rad);
  CHECK(guide.findings().proposals[0].proposed == doctest::Approx(5.0).epsilon(0.001));
  CHECK(guide.findings().proposals[1].proposed == doctest::Approx(-2.5).epsilon(0.001));
}
