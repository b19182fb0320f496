// Tests that voltage, current and speed of healthy motors are consistent. The test measures the margin to a motor
// fault.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "boards/omni_driver/facts.hpp"
#include "firmware/control/settings.hpp"
#include "firmware/control/supervision/current_jump.hpp"
#include "firmware/control/supervision/motor_check.hpp"

#include "tests/system/board_rig.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using control::MotorCheck;
using protocol::ForceMode;
using protocol::Parameter;
using protocol::Signal;

/// Computes the sums of the motor check from streamed signals, because the firmware does not stream its sums.
class CheckedRig : public BoardRig {
 public:
  /// `hotter_K`: additional motor temperature during the self-test.
  explicit CheckedRig(double hotter_K = 0.0) {
    set({{Parameter::force_ramp_s, 0.0f}, {Parameter::speed_limit_m_per_s, 10.0f}});
    heat(hotter_K);
    take_to(free_point_m);
    const protocol::SelfTestReport test = device->self_test();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto entry = [&test, i](protocol::SelfTestItem first) {
        const auto& result = test.entries[static_cast<std::size_t>(of_axis(first, i))];
        REQUIRE(result.result == protocol::SelfTestResult::passed);
        return result.figure;
      };
      measured_.bridge_loss_part[i] = entry(protocol::SelfTestItem::bridge_1) / board::supply_nominal_V;
      measured_.resistance_ohm[i] = entry(protocol::SelfTestItem::motor_1);
    }
    make_active();
    device->select_signals(std::array{
        Signal::duty_1, Signal::duty_2, Signal::duty_3, Signal::current_1_A, Signal::current_2_A, Signal::current_3_A,
        Signal::joint_speed_1_rad_s, Signal::joint_speed_2_rad_s, Signal::joint_speed_3_rad_s, Signal::supply_V,
        Signal::motor_heat_1, Signal::motor_heat_2, Signal::motor_heat_3, Signal::current_reference_1_A,
        Signal::current_reference_2_A, Signal::current_reference_3_A});
    advance(0.05);
    restart();
  }

  void heat(double hotter_K) {
    control.heal_all();
    if (hotter_K == 0.0) return;
    for (const char* motor : {"1", "2", "3"}) control.inject({.fault = "motor_hot", .of = motor, .amount = hotter_K});
  }

  void restart() {
    motor_check_ = {};
    previous_V_.clear();
    nearest_V = largest_left_V = largest_beyond_V = fastest_rad_per_s = strongest_N = 0.0f;
    before_.clear();
    largest_change_A = largest_sudden_A = 0.0f;
  }

  void change(std::initializer_list<device::ParameterChange> changes) {
    set(changes);
    settings_ = control::prepare(device->parameters());
  }

  /// Advances board time and runs `each_millisecond` every millisecond.
  template <class Action>
  void advance(double time_s, const Action& each_millisecond) {
    for (auto left = std::lround(1000 * time_s); left > 0; --left) {
      each_millisecond();
      pass(0.001);
    }
  }
  void advance(double time_s) {
    constexpr double slice_s = 0.01;  // the stream buffers are larger
    for (auto left = std::lround(time_s / slice_s); left > 0; --left) {
      device->send(protocol::Command::heartbeat);
      pass(slice_s);
    }
  }

  /// Largest deviation sum; a fault requires MotorWatch::tolerance_sum_V.
  float nearest_V = 0.0f;
  /// Largest deviation from the expected voltage, and largest excess over the tolerance.
  float largest_left_V = 0.0f, largest_beyond_V = 0.0f;
  float fastest_rad_per_s = 0.0f, strongest_N = 0.0f;
  bool force_is_on = false;
  /// Largest current change per control period, and its largest deviation from the expected change. A deviation above
  /// CurrentJump::tolerance_A would be a fault.
  float largest_change_A = 0.0f, largest_sudden_A = 0.0f;

 private:
  void pass(double time_s) {
    control.run(time_s);
    while (const auto pose = device->read_pose(0ms)) {
      CHECK(pose->fault == protocol::Fault::none);
      strongest_N = std::max(strongest_N, std::hypot(pose->force_N[0], pose->force_N[1], pose->force_N[2]));
      force_is_on = protocol::force_is_on(pose->state);
    }
    while (const auto samples = device->read_scope(0ms)) check_samples(*samples);
  }

  void check_samples(const device::ScopeSamples& samples) {
    REQUIRE(samples.lost_before == 0);
    const std::size_t width = samples.signals.size();
    for (std::size_t row = 0; row < samples.count; ++row, ++period_) {
      const float* value = &samples.values[row * width];
      look_for_jumps({value, width});
      previous_V_.push_back({value[0] * value[9], value[1] * value[9], value[2] * value[9]});
      if (previous_V_.size() < 3) continue;
      const std::size_t motor = period_ % 3;
      fastest_rad_per_s = std::max(fastest_rad_per_s, std::fabs(value[6 + motor]));
      const float previous_V = previous_V_.front()[motor];
      previous_V_.pop_front();
      const float dead_part = board::omni_driver.bridge_dead_time_part();
      const control::BridgeLoss loss{std::min(measured_.bridge_loss_part[motor], dead_part) * value[9],
                                     dead_part * value[9]};
      const control::MotorModel& model = settings_.motor_model;
      const auto resistance =
          control::Resistance::of(measured_.resistance_ohm[motor], value[10 + motor], model.resistance_ohm[motor]);
      motor_check_.turn_to(motor, previous_V, loss);
      motor_check_.update({value[3], value[4], value[5]}, {value[6], value[7], value[8]},
                          {resistance, resistance, resistance}, model.back_emf_Vs_per_rad);
      nearest_V = std::max(nearest_V, motor_check_.beyond_V[motor]);
      const auto deviation = control::unexplained(previous_V, loss, value[3 + motor], value[6 + motor], resistance,
                                                  model.back_emf_Vs_per_rad[motor]);
      largest_left_V = std::max(largest_left_V, deviation.voltage_V);
      largest_beyond_V = std::max(largest_beyond_V, deviation.voltage_V - deviation.tolerance_V);
    }
  }

  void look_for_jumps(std::span<const float> values) {
    for (std::size_t motor = 0; motor < 3 && !before_.empty(); ++motor) {
      const float change_A = std::fabs(values[3 + motor] - before_[3 + motor]);
      const float error_A = std::fabs(before_[13 + motor] - before_[3 + motor]);
      const float back_emf_V = std::fabs(settings_.motor_model.back_emf_Vs_per_rad[motor] * before_[6 + motor]);
      largest_change_A = std::max(largest_change_A, change_A);
      largest_sudden_A = std::max(largest_sudden_A, change_A - error_A - back_emf_V / measured_.resistance_ohm[motor]);
    }
    before_.assign(values.begin(), values.end());
  }

  control::Settings settings_ = control::prepare(protocol::default_parameters());
  std::vector<float> before_;         ///< values of the previous period
  control::MeasuredMotors measured_;  ///< from the self-test; the firmware assumes cold motors there
  MotorCheck motor_check_;
  std::deque<control::Triple> previous_V_;
  std::size_t period_ = 0;
};

void check(CheckedRig& rig, const std::string& what) {
  MESSAGE("simulation, ", what, ": at ", rig.fastest_rad_per_s, " rad/s of a joint and ", rig.strongest_N,
          " N a motor came to ", rig.nearest_V, " of ", MotorCheck::tolerance_sum_V, " V; a look left ",
          rig.largest_left_V, " V, at most ", rig.largest_beyond_V, " V more than is bearable; a current changed by ",
          rig.largest_change_A, " A in a period, by ", rig.largest_sudden_A, " A without a reason");
  CHECK(rig.force_is_on);
  CHECK(rig.largest_left_V > 0.1f);  // the check was active
  CHECK(rig.largest_change_A > 0.01f);
  CHECK(rig.largest_sudden_A < 0.6f * control::CurrentJump::tolerance_A);
  CHECK(rig.nearest_V < 0.2f * MotorCheck::tolerance_sum_V);
  rig.restart();
}

/// Moves the hand `times` times back and forth between two points.
void swing(CheckedRig& rig, device::Vector3 from_m, device::Vector3 to_m, double half_period_s, int times,
           double stiffness_N_per_m = 1500, double damping_Ns_per_m = 12) {
  rig.control.hand({true, from_m, stiffness_N_per_m, damping_Ns_per_m});
  std::vector<device::HandWaypoint> path{{0.0, from_m}};
  for (int i = 1; i <= times; ++i) path.push_back({i * half_period_s, i % 2 == 0 ? from_m : to_m});
  rig.control.hand_path(path);
  rig.advance(times * half_period_s);
}

void shake(CheckedRig& rig, const std::string& how) {
  swing(rig, offset_from_free_point(-0.05, -0.02, -0.02), offset_from_free_point(0.05, 0.03, 0.02), 0.045, 12, 4000,
        30);
  check(rig, how + "shaken");
}

void knock_on_a_stiff_wall(CheckedRig& rig, const std::string& how) {
  rig.change({{Parameter::wall_stiffness_N_per_m, 3000.0f}, {Parameter::force_limit_N, 8.0f}});
  rig.advance(0.2);
  swing(rig, free_point_m, offset_from_free_point(0.0, 0.0, -0.10), 0.1, 4);
  check(rig, how + "knocked on a stiff wall");
}

void press_into_three_walls(CheckedRig& rig, const std::string& how) {
  swing(rig, free_point_m, offset_from_free_point(0.12, -0.12, -0.12), 0.3, 2);
  check(rig, how + "pressed into three walls");
}

void drive_to_and_fro(CheckedRig& rig, const std::string& how) {
  rig.change({{Parameter::program_force_change_N_per_s, 20000.0f}, {Parameter::force_change_N_per_s, 20000.0f}});
  rig.control.hand({true, free_point_m, 600, 8});
  for (const int milliseconds : {10, 3, 2, 1}) {
    int millisecond = 0;
    rig.advance(0.4, [&] {
      const float sign = millisecond++ / milliseconds % 2 == 0 ? 1.0f : -1.0f;
      rig.device->send_force({.force_N = {4.0f * sign, 5.0f * sign, 4.0f * sign}, .mode = ForceMode::beside_walls});
    });
    check(rig, how + "driven by a program to and fro, " + std::to_string(milliseconds) + " ms each");
  }
}

}  // namespace

TEST_CASE("healthy motors stay far from a fault") {
  CheckedRig rig;
  shake(rig, "");
  knock_on_a_stiff_wall(rig, "");
  press_into_three_walls(rig, "");
  drive_to_and_fro(rig, "");
  rig.change({{Parameter::voltage_limit_V, 5.0f}});
  rig.advance(0.1);
  swing(rig, offset_from_free_point(-0.05, -0.02, -0.02), offset_from_free_point(0.05, 0.03, 0.02), 0.08, 4, 4000, 30);
  press_into_three_walls(rig, "with loops that get too little voltage, ");
  rig.change({{Parameter::voltage_limit_V, 16.0f}});
  rig.control.hand({false, {}, 0, 0});
  rig.advance(0.3);
  check(rig, "let go of");
}

TEST_CASE("motors that are 100 K hotter during their test stay far from a fault, both hot and cooled") {
  CheckedRig rig(100.0);
  for (const std::string how : {"hot, ", "cooled, "}) {
    knock_on_a_stiff_wall(rig, how);
    press_into_three_walls(rig, how);
    drive_to_and_fro(rig, how);
    rig.heat(0.0);
  }
}

TEST_CASE("motors that are 50 K hotter than their currents explain keep far from a fault") {
  CheckedRig rig;
  rig.heat(50.0);
  knock_on_a_stiff_wall(rig, "50 K hotter, ");
  press_into_three_walls(rig, "50 K hotter, ");
  drive_to_and_fro(rig, "50 K hotter, ");
}

TEST_CASE("motors with a supply that sags keep far from a fault") {
  CheckedRig rig;
  rig.control.inject({.fault = "supply_sag", .amount = 13.0});
  knock_on_a_stiff_wall(rig, "from 13 V, ");
  drive_to_and_fro(rig, "from 13 V, ");
}

}  // namespace inkwell::tests
