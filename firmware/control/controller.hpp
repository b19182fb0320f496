// Signal path of the control interrupt.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "firmware/control/settings.hpp"
#include "firmware/control/signal_path/conditioning.hpp"
#include "firmware/control/signal_path/energy_reserve.hpp"
#include "firmware/control/signal_path/felt_force_law.hpp"
#include "firmware/control/signal_path/program_force.hpp"
#include "firmware/control/signal_path/samples.hpp"
#include "firmware/control/signal_path/test_pulse.hpp"
#include "firmware/control/signal_path/touch.hpp"
#include "firmware/control/signal_path/transition.hpp"
#include "firmware/control/signal_path/velocity.hpp"
#include "firmware/control/supervision/brake.hpp"
#include "firmware/control/supervision/current_jump.hpp"
#include "firmware/control/supervision/self_test_pulses.hpp"
#include "firmware/control/supervision/supervisor.hpp"
#include "protocol/reports.hpp"
#include "protocol/signals.hpp"

namespace inkwell::control {

/// All functions that change the state run in the control interrupt. In each control period, call the request functions
/// first, then step(), then finish(). Only the constructor, raise and start_warm are called before the control
/// interrupt is enabled.
class Controller {
 public:
  explicit Controller(const BoardLimits& board, std::uint32_t first_period = 0)
      : board_(board), periods_(first_period) {}

  /// Sets the initial heat of the motors. Without this call the motors are assumed to be cold.
  void start_warm(const Warmth& warmth) {
    heat_.heat = warmth.heat;
    heat_.housing = warmth.housing;
    heat_.too_hot = warmth.too_hot != 0;
  }

  /// Runs one control period. `clock.lap()` returns the processor cycles since its previous call. The first call in a
  /// period returns the cycles since the interrupt entry.
  template <class StageClock>
  Drive step(const Samples& samples, const Settings& settings, StageClock& clock) {
    condition_samples(samples, settings);
    cycles_[sample] = clock.lap();
    find_pose(settings);
    cycles_[pose] = clock.lap();
    render_force(settings);
    cycles_[contact] = clock.lap();
    find_current_references(settings);
    cycles_[torque] = clock.lap();
    regulate_currents(settings);
    cycles_[current] = clock.lap();
    supervise(samples, settings);
    ++periods_;
    return drive_;
  }

  /// Completes the cycle measurement. Call this function at the end of the control interrupt.
  template <class StageClock>
  void finish(StageClock& clock) {
    cycles_[report] = clock.lap();
    servo_cycles_ = 0;
    for (const std::uint32_t cycles : cycles_) servo_cycles_ += cycles;
  }

  /// Call this function when the settings have changed. The force changes gradually if walls, force law, shapes or
  /// force limit change. Changes of motor current limits apply immediately.
  void settings_changed() { world_changed_ = true; }
  /// Executes a command in the next step. `command` must be valid. A command resets the host timeout.
  [[gnu::cold]] void carry_out(const protocol::CommandReport& command);
  /// Resets the host timeout. Call this function for every output report.
  void host_alive() { host_silence_periods_ = 0; }
  /// Sets the force of a program on the PC.
  [[gnu::cold]] void drive(const ForceTarget& target, const Settings& settings);
  /// Sets the shapes of a program on the PC. `shapes` has tangent planes, and belongs to the controller until the next
  /// call.
  void replace_shapes(Shapes& shapes);
  /// Sets the local model of a program on the PC, under the same conditions.
  void follow(LocalModel& model) { touch_.follow(model); }
  /// Position of the proxy after the last step.
  const Vector3& proxy_m() const { return touch_.proxy_m(); }
  /// Sum of the depths of the probe in the surfaces that it touched in the last step.
  float depth_m() const { return touch_.depth_m(); }
  /// Requests the state `update`. Call this function in each period until the boot loader starts.
  void leave_for_update() { pending_.events |= protocol::events(protocol::Event::update); }
  /// Reports faults found outside the signal path. The faults switch the bridges off in the next step.
  void raise(protocol::Conditions found) { pending_.found |= found; }
  void raise(protocol::Fault fault) { raise(protocol::condition(fault)); }

  // ---- self-test ----

  /// Starts the test pulses of a self-test.
  void start_pulses(const PulseSize& size) { pulses_.start(size); }
  bool pulses_run() const { return pulses_.runs(); }
  const PulseRound& pulse_round() const { return pulses_.round(); }
  const Triple& current_offsets_A() const { return offsets_.offset_A; }
  /// Call this function if the self-test found no fault that prevents the force.
  [[gnu::cold]] void pass_self_test(const MeasuredMotors& measured);
  /// Number of self-tests since boot.
  std::uint32_t self_tests() const { return self_tests_; }

  /// Writes the signals of the last step. Before finish() is called, the total cycle count belongs to the previous
  /// period.
  void write_signals(protocol::SignalValues& signals) const;
  protocol::SignalValues signals() const {
    protocol::SignalValues signals;
    write_signals(signals);
    return signals;
  }
  protocol::State state() const { return supervisor_.state; }
  protocol::Fault fault() const { return supervisor_.fault; }
  std::uint8_t switches() const { return switches_.closed; }                ///< bits of protocol::Switch, debounced
  std::uint8_t force_sources() const { return force_sources_; }             ///< bits of protocol::ForceSource
  std::uint8_t limits() const { return limits_; }                           ///< bits of protocol::Limit
  bool is_referenced() const { return reference_.valid; }                   ///< whether the arm position is known
  std::uint32_t late_force_reports() const { return late_force_reports_; }  ///< since boot
  std::uint32_t periods() const { return periods_; }            ///< control periods completed since boot; wraps
  std::uint32_t servo_cycles() const { return servo_cycles_; }  ///< cycles of the last finished control interrupt
  const Triple& motor_heat() const { return heat_.heat; }  ///< 1 is the steady-state heat at the continuous current
  /// Motor heat for start_warm() in the next run.
  Warmth warmth() const { return {heat_.heat, heat_.housing, heat_.too_hot ? 1u : 0u}; }
  bool force_is_on() const { return force_is_on_; }  ///< according to the state

 private:
  enum Stage : std::uint8_t { sample, pose, contact, torque, current, report, stage_count };

  void condition_samples(const Samples& samples, const Settings& settings);
  [[gnu::cold]] void check_for_jumps(const Triple& change_A, const Settings& settings);
  void find_pose(const Settings& settings);
  void render_force(const Settings& settings);
  void limit_and_apply_force(Force requested, const Settings& settings);
  // Rarely executed code is compiled for size, because the interrupt memory is small.
  [[gnu::cold]] Force reduce_driving_part(const Force& requested, float power_W, const Settings& settings);
  void find_current_references(const Settings& settings);
  [[gnu::cold]] void update_resistance(const Settings& settings);
  void check_motors(const Settings& settings);
  void bound_voltages(const Settings& settings);
  void regulate_currents(const Settings& settings);
  [[gnu::cold]] void check_idle_currents();
  [[gnu::cold]] void check_inkwell_switch(const Settings& settings);
  /// Largest reliably measured current magnitude.
  float known_A(std::size_t motor) const { return board_.current_measurable_A - std::fabs(offsets_.offset_A[motor]); }
  [[gnu::cold]] void follow_over_current(const Settings& settings);
  [[gnu::cold]] float test_limit_A(const Settings& settings) const;
  [[gnu::cold]] float test_voltage_V(const Settings& settings) const;
  void follow_test(protocol::Conditions found, const Settings& settings);
  [[gnu::cold]] void drive_pulses(const Settings& settings);
  void supervise(const Samples& samples, const Settings& settings);
  void change_state(const Supervisor& next);

  BoardLimits board_;
  MeasuredMotors measured_;  ///< from pass_self_test()

  // State between periods.
  std::uint32_t periods_;
  CurrentOffsets offsets_;
  SupplyFilter supply_;
  SwitchFilter switches_;
  InkwellReference reference_;
  std::array<SpeedEstimate, 3> speeds_{};
  std::size_t turn_ = 0;  ///< joint, motor and gimbal angle to process in this period
  std::array<CurrentLoop, 3> loops_{};
  MotorHeat heat_;
  std::array<Resistance, 3> resistances_{};
  MotorCheck motor_check_;
  std::array<VoltageRange, 3> voltage_ranges_{};
  Triple over_current_A_{};             ///< bound of the over-current fault
  Triple over_current_for_A_{};         ///< current limits that over_current_A_ has reached, else 0
  std::uint32_t off_zero_periods_ = 0;  ///< consecutive periods with a current although no bridge was on
  TestPulse test_;
  std::uint32_t self_tests_ = 0;
  Supervisor supervisor_;
  Situation pending_;                ///< external requests and faults since the previous period
  protocol::Events lasting_events_;  ///< events requested in every period
  bool force_is_on_ = false;
  Brake brake_;
  float force_gain_ = 0.0f;
  float force_limit_N_ = 0.0f;
  ProgramForce program_;
  bool world_changed_ = false;  ///< shapes or settings changed since the previous period
  bool law_rendered_ = true;    ///< false while a program replaces the walls
  Vector3 rendered_N_;          ///< force of law, shapes and transition in the previous period
  Transition transition_;
  EnergyReserve reserve_;
  std::uint32_t late_force_reports_ = 0;
  std::uint32_t host_silence_periods_ = 0;

  // Results of this period, in the order of the signal path.
  std::array<std::int32_t, 3> encoder_counts_{};  ///< since power-on
  std::uint32_t jump_bits_ = 0;                   ///< not 0 if an encoder moved faster than an arm can move
  std::array<std::int32_t, 3> counts_since_inkwell_{};
  Triple current_A_{};
  Probe probe_;  ///< input of the force law
  Triple joint_speed_rad_per_s_{};
  Jacobian jacobian_{};
  Force force_{};
  std::uint8_t force_sources_ = 0;
  std::uint8_t limits_ = 0;
  Triple torque_Nm_{};
  Triple reference_A_{};
  Drive drive_;

  std::array<std::uint32_t, stage_count> cycles_{};
  std::uint32_t servo_cycles_ = 0;

  // Large members are declared last to keep the offsets of the other members small.
  Touch touch_;
  FeltForceLaw law_;
  SelfTestPulses pulses_;
};

}  // namespace inkwell::control
