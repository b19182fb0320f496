// Tests the checks by the main loop: supply ripple, dead encoder wires, shorted bridge wires, and a wrong reference
// voltage. The main loop detects each fault in time, and normal use raises no fault.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "firmware/control/supervision/encoder_wire.hpp"
#include "firmware/control/supervision/supply_ripple.hpp"
#include "tests/stepped_board.hpp"

#include "tests/system/hazards.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;
using protocol::Fault;
using protocol::ForceMode;
using protocol::Parameter;
using protocol::Signal;
using protocol::State;

namespace {

/// Moves all joints fast in free space, as in the fault campaign.
void swing(BoardRig& rig, int times) {
  std::vector<device::HandWaypoint> path;
  for (int i = 1; i <= times; ++i)
    path.push_back({0.15 * i, i % 2 == 0 ? offset_from_free_point(-0.03, -0.03, -0.03)
                                         : offset_from_free_point(0.03, 0.03, 0.03)});
  rig.control.hand_path(path);
}

void check_reported(BoardRig& rig, Fault fault) {
  rig.run(0.01);
  CHECK(rig.pose().state == State::fault);
  CHECK(protocol::info(rig.pose().fault).name == protocol::info(fault).name);
}

/// Returns the time after which the bridges are off; the resolution is a tenth of `limit_s`.
double off_after_s(BoardRig& rig, double limit_s) {
  const double begin_s = rig.board_time_s();
  for (int i = 0; i < 20 && bridges_enabled(rig.control); ++i) rig.control.run(0.1 * limit_s);
  const double after_s = rig.board_time_s() - begin_s;
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));
  return after_s;
}

/// Checks that the fault cannot be cleared while its cause lasts, and can be cleared afterward.
void check_clears_when_gone(BoardRig& rig, State then) {
  rig.command(protocol::Command::clear_fault);
  rig.run(0.02);
  CHECK(rig.pose().state == State::fault);
  rig.control.heal_all();
  rig.run(0.15);
  rig.command(protocol::Command::clear_fault);
  rig.run_until([then](const auto& pose) { return pose.state == then; });
}

}  // namespace

TEST_CASE("a supply ripple above the limit raises a fault within 50 ms, and a ripple of 0.9 V does not") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({.fault = "supply_ripple", .amount = 0.9});
  rig.run(0.3);
  CHECK(protocol::force_is_on(rig.pose().state));
  rig.control.inject({.fault = "supply_ripple"});
  CHECK(off_after_s(rig, 0.05) < 0.0501);
  check_reported(rig, Fault::supply_ripple);
  CHECK(largest_current_A(rig.control) < 0.02);
  check_clears_when_gone(rig, State::ready);
}

TEST_CASE("a dead wire of any encoder is noticed in fast motion, not at rest, and voids the reference") {
  const std::array<std::string, 6> wires{"encoders[0].a", "encoders[1].b", "encoders[2].a",
                                         "encoders[0].b", "encoders[1].a", "encoders[2].b"};
  constexpr std::array faults{"wire_open", "wire_low", "wire_high", "wire_frozen"};
  for (std::size_t i = 0; i < wires.size(); ++i) {
    CAPTURE(wires[i]);
    BoardRig rig;
    rig.make_active();
    rig.take_to(free_point_m);
    rig.set({{Parameter::speed_limit_m_per_s, 10.0f}});
    rig.control.inject({.fault = faults[i % faults.size()], .of = wires[i]});
    rig.run(0.2);
    REQUIRE(protocol::force_is_on(rig.pose().state));
    swing(rig, 4);
    CHECK(off_after_s(rig, 0.25) < 0.2501);
    // The motor check may raise a fault first, because the second joint is fast.
    rig.run(0.01);
    const Fault reported = rig.pose().fault;
    check_reported(rig, wires[i].starts_with("encoders[1]") && reported == Fault::motor_implausible
                            ? reported
                            : Fault::encoder_wire);
    rig.command(protocol::Command::clear_fault);
    rig.run_until([](const auto& pose) { return pose.state == State::unreferenced; });
  }
}

TEST_CASE("without the force a dead wire of an encoder is noticed too, once the arm is referenced") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.take_to(free_point_m);
  rig.control.inject({.fault = "wire_low", .of = "encoders[1].a"});
  swing(rig, 4);
  rig.run(0.3);
  check_reported(rig, Fault::encoder_wire);
}

TEST_CASE("a wire of the bridges that touches 3.3 V is noticed while they are off, one that is low stays as it is") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  for (const char* wire : {"bridge_enable", "bridge_hold", "bridges[0].leg_a", "bridges[0].leg_b", "bridges[1].leg_a",
                           "bridges[1].leg_b", "bridges[2].leg_a", "bridges[2].leg_b"}) {
    CAPTURE(wire);
    for (const char* borne : {"wire_low", "wire_open"}) {
      rig.control.inject({.fault = borne, .of = wire});
      rig.run(0.02);
      CHECK(rig.pose().state == State::ready);
    }
    rig.control.inject({.fault = "wire_high", .of = wire});
    rig.control.run(12 * control_period_s);
    rig.command(protocol::Command::enable_force);  // too late to have an effect
    check_reported(rig, Fault::bridge_wire);
    check_clears_when_gone(rig, State::ready);
  }
}

TEST_CASE("a bridge wire that touches 3.3 V for two control periods raises no fault") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  for (int i = 0; i < 9; ++i) {  // the checks run every three control periods
    protocol::InjectionRequest touch{"wire_high", "bridges[1].leg_a"};
    touch.for_s = 2 * control_period_s;
    rig.control.inject(touch);
    rig.run(0.01);
    CHECK(rig.pose().state == State::ready);
    rig.control.run(control_period_s);
  }
}

TEST_CASE("before the arm is referenced a wire of the bridges is checked as well") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.take_to(free_point_m);
  rig.control.reset();
  rig.control.inject({.fault = "wire_high", .of = "bridges[2].leg_b"});
  reconnect(rig);
  check_reported(rig, Fault::bridge_wire);
  check_clears_when_gone(rig, State::unreferenced);
}

TEST_CASE("a heartbeat wire at 3.3 V switches the bridges off immediately, and is detected with the force on and off") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({.fault = "wire_high", .of = "bridge_heartbeat"});
  rig.control.run(2 * control_period_s);
  CHECK_FALSE(bridges_enabled(rig.control));
  check_reported(rig, Fault::heartbeat_missed);
  rig.control.heal("wire_high");
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.control.inject({.fault = "wire_high", .of = "bridge_heartbeat"});
  check_reported(rig, Fault::bridge_wire);
}

TEST_CASE("a fault of the heartbeat, enable or hold wire switches the force off with heartbeat_missed") {
  for (const auto& [fault, wire] : {std::pair{"wire_open", "bridge_heartbeat"},
                                    {"wire_low", "bridge_heartbeat"},
                                    {"wire_open", "bridge_enable"},
                                    {"wire_open", "bridge_hold"},
                                    {"wire_low", "bridge_hold"}}) {
    CAPTURE(fault);
    CAPTURE(wire);
    BoardRig rig;
    press_into_wall(rig);
    rig.control.inject({.fault = fault, .of = wire});
    rig.control.run(4 * control_period_s);
    CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));
    check_reported(rig, Fault::heartbeat_missed);
    CHECK_FALSE(bridges_enabled(rig.control));
  }
}

TEST_CASE("with an enable wire at 3.3 V, the arm still coasts after the force switches off") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({.fault = "wire_high", .of = "bridge_enable"});
  rig.run(0.02);
  CHECK(protocol::force_is_on(rig.pose().state));
  rig.command(protocol::Command::stop);
  const auto pause_s = [&] {
    const auto truth = rig.control.truth();
    return truth.at("board_time_s").get<double>() - truth.at("bridges_driven_until_s").get<double>();
  };
  // The half bridges are low at the end of this wait.
  for (int i = 0; i < 1'000 && pause_s() < control_period_s; ++i) rig.control.run(control_period_s / 10);
  rig.control.run(1.1 * control_period_s);
  CHECK_FALSE(bridges_enabled(rig.control));
  check_reported(rig, Fault::bridge_wire);
}

TEST_CASE("an enable wire that touches ground is noticed within two control periods of the force") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({.fault = "wire_low", .of = "bridge_enable"});
  rig.control.run(2 * control_period_s);
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));
  check_reported(rig, Fault::heartbeat_missed);
  // The enable wire is low while the bridges are off.
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
}

TEST_CASE("an analog supply that is 4.5 % off raises no fault, and 5.5 % raises a fault within 5 ms") {
  for (const double sign : {-1.0, 1.0}) {
    CAPTURE(sign);
    BoardRig rig;
    press_into_wall(rig);
    rig.control.inject({.fault = "analog_sag", .amount = 3.3 * (1.0 + 0.045 * sign)});
    rig.run(0.1);
    CHECK(protocol::force_is_on(rig.pose().state));
    rig.control.inject({.fault = "analog_sag", .amount = 3.3 * (1.0 + 0.055 * sign)});
    CHECK(off_after_s(rig, 0.005) < 0.00501);
    check_reported(rig, Fault::analog_supply);
    check_clears_when_gone(rig, State::ready);
  }
}

TEST_CASE("a supply of the chip that falls switches the bridges off within two control periods, when it comes") {
  BoardRig rig;
  for (int i = 0; i < 5; ++i) {
    press_into_wall(rig);
    rig.control.run(0.37 * i * control_period_s);
    rig.control.inject({.fault = "logic_sag", .amount = 2.9});
    CHECK(off_after_s(rig, 1e-4) <= 2.0 * control_period_s + 1e-9);
    check_reported(rig, Fault::logic_supply_low);
    check_clears_when_gone(rig, State::ready);
  }
}

TEST_CASE("an edge of the chip's supply that is over when its interrupt comes is no fault") {
  BoardRig rig(stepped_board(device::SimulationMode::exact, device::CyclePricing::likely));
  press_into_wall(rig);
  for (int i = 0; i < 5; ++i) {
    rig.control.inject({.fault = "logic_sag", .amount = 2.9, .for_s = 5e-8});
    rig.run(0.0123);
    CHECK(rig.pose().fault == Fault::none);
    CHECK(protocol::force_is_on(rig.pose().state));
  }
}

TEST_CASE(
    "a supply of the chip that falls is a fault before the brown-out, with its name, and clears when it has risen") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  const auto fault_at = [&](double supply_V) {
    rig.control.inject({.fault = "logic_sag", .amount = supply_V});
    rig.run(0.01);
    return rig.pose().fault;
  };
  const auto clear = [&] {
    rig.command(protocol::Command::clear_fault);
    rig.run(0.01);
    return rig.pose().fault;
  };
  CHECK(fault_at(3.2) == Fault::none);
  CHECK(fault_at(2.95) == Fault::analog_supply);  // the reference of the converters falls with the supply
  CHECK(fault_at(3.3) == Fault::analog_supply);
  CHECK(clear() == Fault::none);
  CHECK(fault_at(2.9) == Fault::logic_supply_low);
  CHECK(clear() == Fault::logic_supply_low);
  CHECK(fault_at(3.0) == Fault::logic_supply_low);
  CHECK(clear() == Fault::logic_supply_low);  // the rising threshold is above the falling threshold
  CHECK(fault_at(3.3) == Fault::logic_supply_low);
  CHECK(clear() == Fault::none);
  CHECK(restarts(rig.control) == 0);
}

namespace {

/// Measures the margin between normal use and the fault threshold.
class HonestRig : public BoardRig {
 public:
  HonestRig() {
    set({{Parameter::force_ramp_s, 0.0f},
         {Parameter::speed_limit_m_per_s, 10.0f},
         {Parameter::force_limit_N, 8.0f},
         {Parameter::program_force_change_N_per_s, 20'000.0f}});
    take_to(free_point_m);
    make_active();
    control.hand({true, free_point_m, 600, 8});
    device->select_signals(std::array{Signal::encoder_1_counts, Signal::encoder_2_counts, Signal::encoder_3_counts});
    run(0.2);
    control.trace_start();
  }

  template <class Action>
  void use(double time_s, const Action& each_millisecond) {
    for (auto left = std::lround(1000 * time_s); left > 0; --left) {
      each_millisecond();
      control.run(0.001);
      while (const auto pose = device->read_pose(0ms)) {
        CHECK(pose->fault == Fault::none);
        force_is_on = protocol::force_is_on(pose->state);
      }
      while (const auto samples = device->read_scope(0ms)) check_samples(*samples);
    }
    look_at_supply();
  }
  void use(double time_s) {
    int millisecond = 0;
    use(time_s, [this, &millisecond] {
      if (++millisecond % 10 == 0) command(protocol::Command::heartbeat);
    });
  }

  void check(const std::string& what) {
    MESSAGE("simulation, ", what, ": a count went to and fro ", most_changes, " times in 0.1 s, ",
            control::EncoderWire::dead_changes, " are a dead wire; the supply swung by at most ", largest_swing_V,
            " V to both sides within 15 ms, ", protocol::supply_ripple_V, " V to either are ripple");
    CHECK(force_is_on);
    CHECK(most_changes <= control::EncoderWire::dead_changes * 9 / 10);
    CHECK(largest_swing_V < static_cast<double>(protocol::supply_ripple_V));
    most_changes = 0;
    largest_swing_V = 0.0;
  }

 private:
  void check_samples(const device::ScopeSamples& samples) {
    REQUIRE(samples.lost_before == 0);
    for (std::size_t row = 0; row < samples.count; ++row, ++period_)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto count = static_cast<std::int32_t>(samples.values[3 * row + i]);
        wires_[i].detect_dead_wire(static_cast<std::uint16_t>(count), period_);
        most_changes = std::max(most_changes, wires_[i].changes);
      }
  }

  /// The slowest ripple reverses every 14 ms. The largest possible ripple is half of the supply's range within 14 ms.
  void look_at_supply() {
    const device::Trace trace = control.trace_read(100'000);
    const auto column = std::ranges::find(trace.columns, "true_supply_V");
    REQUIRE(column != trace.columns.end());
    constexpr std::size_t rows_together = 300;
    double lowest_V = 1e9, highest_V = 0.0;
    for (std::size_t row = 0; row < trace.row_count(); ++row) {
      const double supply_V =
          trace.values[row * trace.columns.size() + static_cast<std::size_t>(column - trace.columns.begin())];
      if (row % rows_together == 0) lowest_V = highest_V = supply_V;
      lowest_V = std::min(lowest_V, supply_V);
      highest_V = std::max(highest_V, supply_V);
      largest_swing_V = std::max(largest_swing_V, 0.5 * (highest_V - lowest_V));
    }
  }

  std::array<control::EncoderWire, 3> wires_{};
  std::uint32_t period_ = 0, most_changes = 0;
  double largest_swing_V = 0.0;
  bool force_is_on = false;
};

}  // namespace

TEST_CASE("forces that a program turns round, at any rate and as strong as can be, are neither ripple nor dead wires") {
  HonestRig rig;
  for (const int half_period_ms : {20, 12, 5, 2, 1}) {
    int millisecond = 0;
    rig.use(0.3, [&] {
      const float sign = millisecond++ / half_period_ms % 2 == 0 ? 1.0f : -1.0f;
      rig.device->send_force({.force_N = {4.6f * sign, 4.6f * sign, 4.6f * sign}, .mode = ForceMode::beside_walls});
    });
    rig.check("forces turned round each " + std::to_string(half_period_ms) + " ms");
  }
}

TEST_CASE("a hand that shakes the arm, and one that knocks on the hardest walls, break no wire") {
  HonestRig rig;
  rig.set({{Parameter::wall_stiffness_N_per_m, 3'000.0f}});
  rig.control.hand({true, free_point_m, 4'000, 30});
  swing(rig, 4);
  rig.use(0.6);
  rig.check("shaken");
  rig.control.hand({true, free_point_m, 1'500, 12});
  rig.control.hand_path({{0.1, offset_from_free_point(0.0, 0.0, -0.10)},
                         {0.2, free_point_m},
                         {0.3, offset_from_free_point(0.0, 0.0, -0.10)}});
  rig.use(0.4);
  rig.check("knocked on a wall");
  // The hand holds the probe loosely at the edge of the walls, where vibrations are most likely.
  rig.set({{Parameter::box_minimum_z_m, -0.0301f}});
  for (const double stiffness_N_per_m : {50.0, 200.0}) {
    rig.control.hand({true, free_point_m, stiffness_N_per_m, 0.5});
    rig.use(0.4);
  }
  rig.check("held at a wall's edge");
}
