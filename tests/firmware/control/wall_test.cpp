// Tests the controller in a closed loop with a simulated arm. The arm has motors with winding and back-EMF, joints with
// inertia and friction, and encoders. A simulated hand pulls the probe to a target. The inertia is constant and gravity
// is omitted, unlike on the virtual board.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace {

using namespace inkwell;
using control::Triple;
using control::Vector3;
using protocol::Parameter;
using protocol::Signal;

class SimulatedArm {
 public:
  explicit SimulatedArm(const protocol::ParameterSet& parameters) : settings_(control::prepare(parameters)) {
    joint_rad_ = settings_.encoders.inkwell_rad;
    inkwell_rad_ = joint_rad_;
    hand_m = control::forward_kinematics(joint_rad_, settings_.arm).position_m;
  }

  Vector3 hand_m;  ///< target of the hand for the probe

  control::Samples samples() const {
    control::Samples samples = tests::samples_at_rest();
    samples.current_A = current_A_;
    for (std::size_t i = 0; i < 3; ++i)
      samples.encoder_counts[i] = static_cast<std::int32_t>(
          std::floor((joint_rad_[i] - inkwell_rad_[i]) / settings_.encoders.rad_per_count[i] + 0.5f));
    return samples;
  }

  /// Simulates one control period with the current duty cycles of the bridges.
  void run(const control::Drive& drive) {
    constexpr int steps = 10;
    constexpr float step_s = protocol::servo_period_s / steps;
    for (int step = 0; step < steps; ++step) advance(drive, step_s);
  }

  const control::Settings& settings() const { return settings_; }

 private:
  void advance(const control::Drive& drive, float step_s) {
    using namespace arm_defaults::motor;
    constexpr float supply_V = board::supply_nominal_V;
    constexpr Triple inertia_kg_m2{1.1e-3f, 1.1e-3f, 0.6e-3f};
    constexpr float coulomb_Nm = 0.01f, viscous_Nms_per_rad = 0.0005f;
    constexpr float hand_N_per_m = 300.0f, hand_Ns_per_m = 3.0f;

    const control::Pose pose = control::forward_kinematics(joint_rad_, settings_.arm);
    const Vector3 velocity = control::probe_velocity(pose.jacobian, speed_rad_per_s_);
    const Vector3 pull_N = hand_N_per_m * (hand_m - pose.position_m) - hand_Ns_per_m * velocity;
    const Triple hand_Nm = control::joint_torques(pose.jacobian, pull_N);
    for (std::size_t i = 0; i < 3; ++i) {
      const float Nm_per_A = 1.0f / settings_.motors.ampere_per_Nm[i];
      const float voltage_V = drive.enabled ? drive.duty[i] * supply_V - speed_rad_per_s_[i] * Nm_per_A : 0.0f;
      current_A_[i] = drive.enabled
                          ? current_A_[i] + step_s / inductance_H *
                                                (voltage_V - settings_.motor_model.resistance_ohm[i] * current_A_[i])
                          : 0.0f;
      const float friction_Nm =
          coulomb_Nm * std::tanh(speed_rad_per_s_[i] / 0.005f) + viscous_Nms_per_rad * speed_rad_per_s_[i];
      const float torque_Nm = current_A_[i] * Nm_per_A + hand_Nm[i] - friction_Nm;
      speed_rad_per_s_[i] += step_s * torque_Nm / inertia_kg_m2[i];
      joint_rad_[i] += step_s * speed_rad_per_s_[i];
    }
  }

  control::Settings settings_;
  Triple joint_rad_{}, inkwell_rad_{};
  Triple speed_rad_per_s_{};
  Triple current_A_{};
};

/// Measured values of one push.
struct Push {
  float largest_force_N = 0.0f;
  float deepest_m = 0.0f;
  float law_error_N = 0.0f;      ///< deviation from F = k d + c d' with the logged values
  float current_error_A = 0.0f;  ///< mean deviation from the reference while the hand is steady
  float lowest_steady_m = 1.0f;
  float highest_steady_m = -1.0f;
  protocol::State state;
};

/// In 0.3 s the hand moves 14 mm along x and stops 10 mm beyond the wall surface.
Push push_against_wall(protocol::ParameterSet parameters) {
  parameters[Parameter::sphere_radius_m] = 0.0f;
  parameters[Parameter::force_ramp_s] = 0.02f;
  for (const Parameter bound : {Parameter::box_minimum_x_m, Parameter::box_minimum_y_m, Parameter::box_minimum_z_m})
    parameters[bound] = -0.4f;
  for (const Parameter bound : {Parameter::box_maximum_y_m, Parameter::box_maximum_z_m}) parameters[bound] = 0.4f;
  const Vector3 start_m = SimulatedArm{parameters}.hand_m;
  parameters[Parameter::box_maximum_x_m] = start_m.x + 0.004f;
  SimulatedArm arm{parameters};
  const control::Settings& settings = arm.settings();
  control::Controller controller = tests::active_controller(settings);
  tests::FakeClock clock;

  Push push;
  control::Drive next;  // a duty cycle becomes active one period after its samples
  constexpr int move_periods = 6'000, settle_periods = 2'000, steady_periods = 4'000, ramp_periods = 500;
  for (int period = -ramp_periods; period < move_periods + settle_periods + steady_periods; ++period) {
    const float part = control::clamp(static_cast<float>(period) / move_periods, 0.0f, 1.0f);
    arm.hand_m.x = start_m.x + 0.014f * part;
    controller.host_alive();
    const control::Drive drive = controller.step(arm.samples(), settings, clock);
    arm.run(next);
    next = drive;

    const protocol::SignalValues& signals = controller.signals();
    const float depth_m = -signals[Signal::penetration_x_m];
    const float force_N = -signals[Signal::force_x_N];
    push.largest_force_N = std::max(push.largest_force_N, force_N);
    push.deepest_m = std::max(push.deepest_m, depth_m);
    if (force_N > 0.0f && force_N < settings.force_limit_N) {
      const float law_N =
          settings.wall.stiffness_N_per_m * depth_m + settings.wall.damping_Ns_per_m * signals[Signal::velocity_x_m_s];
      push.law_error_N = std::max(push.law_error_N, std::abs(force_N - law_N));
    }
    if (period < move_periods + settle_periods) continue;
    push.lowest_steady_m = std::min(push.lowest_steady_m, signals[Signal::position_x_m]);
    push.highest_steady_m = std::max(push.highest_steady_m, signals[Signal::position_x_m]);
    // The reference alternates when the probe rests between two counts, so the test evaluates the mean error.
    push.current_error_A +=
        (signals[Signal::current_1_A] - signals[Signal::current_reference_1_A]) / static_cast<float>(steady_periods);
  }
  push.state = controller.state();
  return push;
}

TEST_CASE("a push against a wall: the law holds, the current follows, and a steady hand rests within two counts") {
  for (const tests::Arm& arm : tests::all_arms()) {
    CAPTURE(arm.name);
    const Push push = push_against_wall(arm.parameters);
    const control::Settings settings = control::prepare(arm.parameters);
    const float reach_m = settings.arm.link_2_m + settings.arm.link_3_m;
    const float two_counts_m = 2.0f * reach_m * std::abs(settings.encoders.rad_per_count[0]);
    MESSAGE("deepest " << push.deepest_m * 1e3f << " mm, largest force " << push.largest_force_N << " N, rests within "
                       << (push.highest_steady_m - push.lowest_steady_m) * 1e6f << " um, current off by "
                       << push.current_error_A * 1e3f << " mA");
    CHECK(protocol::force_is_on(push.state));
    CHECK(push.largest_force_N > 1.5f);
    CHECK(push.largest_force_N <= 3.3001f);
    CHECK(push.deepest_m < 0.005f);
    CHECK(push.law_error_N < 0.005f);
    CHECK(push.highest_steady_m - push.lowest_steady_m < two_counts_m);
    CHECK(std::abs(push.current_error_A) < 0.005f);
  }
}

}  // namespace
