// The signal path of the control interrupt, and what it remembers from one period to the next.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <control/brake.hpp>
#include <control/conditioning.hpp>
#include <control/current_jump.hpp>
#include <control/energy_reserve.hpp>
#include <control/felt_force_law.hpp>
#include <control/program_force.hpp>
#include <control/samples.hpp>
#include <control/self_test_pulses.hpp>
#include <control/settings.hpp>
#include <control/shapes.hpp>
#include <control/supervisor.hpp>
#include <control/test_pulse.hpp>
#include <control/transition.hpp>
#include <control/velocity.hpp>
#include <protocol/reports.hpp>
#include <protocol/signals.hpp>

namespace inkwell::control {

/// Everything between the samples and the duties. Single-threaded: all that changes it is called in the control
/// interrupt, in the order settings_changed / carry_out / host_alive / drive / replace_shapes / leave_for_update /
/// raise, self-test, step, finish; before that interrupt runs, the constructor, raise and start_warm.
class Controller {
 public:
  /// `first_period` is the number of the first control period.
  explicit Controller(const BoardLimits& board, std::uint32_t first_period = 0)
      : board_(board), periods_(first_period) {}

  /// Before the control interrupt runs: the motors are as warm as that. Without it they are cold.
  void start_warm(const Warmth& warmth) {
    heat_.heat = warmth.heat;
    heat_.housing = warmth.housing;
    heat_.too_hot = warmth.too_hot != 0;
  }

  /// One control period. `clock.lap()` returns the processor cycles since the lap before as std::uint32_t;
  /// its first lap in a period counts from the interrupt's entry.
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

  /// Ends the period's measure of time: call it last, when the bridges are written and the records are made.
  template <class StageClock>
  void finish(StageClock& clock) {
    cycles_[report] = clock.lap();
    servo_cycles_ = 0;
    for (const std::uint32_t cycles : cycles_) servo_cycles_ += cycles;
  }

  /// The next step's settings are others than the last one's. What they do to walls, force law, shapes and force limit
  /// is got over without a kick; a motor's own current limit holds at once.
  void settings_changed() { world_changed_ = true; }
  /// Carries out a command that the link has validated, in the next step. Counts as a sign of life.
  [[gnu::cold]] void carry_out(const protocol::CommandReport& command);
  /// The host was heard: any output report came in.
  void host_alive() { host_silence_periods_ = 0; }
  /// A program on the PC asks for a force.
  [[gnu::cold]] void drive(const ForceTarget& target, const Settings& settings);
  /// A program on the PC has placed other shapes; they must stay as they are until the next call.
  void replace_shapes(const Shapes& shapes);
  /// The board is about to start its boot loader; called in each period in which it is.
  void leave_for_update() { asked_.events |= protocol::events(protocol::Event::update); }
  /// Reports faults found outside the signal path; they switch the bridges off in the next step.
  void raise(protocol::Watches found) { asked_.found |= found; }
  void raise(protocol::Fault fault) { raise(protocol::watch(fault)); }

  // ---- while the state is `testing`, likewise before step ----
  /// Sends a round of pulses to the motors.
  void start_pulses() { pulses_.start(); }
  bool pulses_run() const { return pulses_.runs(); }
  const PulseRound& pulse_round() const { return pulses_.round(); }
  const Triple& current_offsets_A() const { return offsets_.offset_A; }
  /// The self-test is over, and nothing has failed that takes the force away.
  [[gnu::cold]] void pass_self_test(const MeasuredMotors& measured);
  /// It has begun so many times since the start.
  std::uint32_t self_tests() const { return self_tests_; }

  /// The signals of the last step. Before finish(), the cycles of the last stage and of all stages are those of the
  /// period before.
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
  bool is_referenced() const { return reference_.valid; }                   ///< it is known where the arm is
  std::uint32_t late_force_reports() const { return late_force_reports_; }  ///< since the start
  std::uint32_t periods() const { return periods_; }            ///< control periods completed since the start; wraps
  std::uint32_t servo_cycles() const { return servo_cycles_; }  ///< of the last finished control interrupt
  const Triple& motor_heat() const { return heat_.heat; }       ///< 1 is what the continuous current leads to
  /// What start_warm() of the next run is to get.
  Warmth warmth() const { return {heat_.heat, heat_.housing, heat_.too_hot ? 1u : 0u}; }
  bool force_is_on() const { return force_is_on_; }  ///< whether the state says so

 private:
  enum Stage : std::uint8_t { sample, pose, contact, torque, current, report, stage_count };

  void condition_samples(const Samples& samples, const Settings& settings);
  [[gnu::cold]] void look_for_jump(const Triple& change_A, const Settings& settings);
  void find_pose(const Settings& settings);
  void render_force(const Settings& settings);
  void give(Force asked, const Settings& settings);
  // What is rare is compiled to be short: the interrupts' memory is small.
  [[gnu::cold]] Force less_driving(const Force& asked, float power_W, const Settings& settings);
  void find_current_references(const Settings& settings);
  [[gnu::cold]] void know_resistance(const Settings& settings);
  void watch_motors(const Settings& settings);
  void bound_voltages(const Settings& settings);
  void regulate_currents(const Settings& settings);
  [[gnu::cold]] void watch_idle_currents();
  [[gnu::cold]] void watch_inkwell_switch(const Settings& settings);
  /// The largest current, of either sign, that its sensor surely shows.
  float known_A(std::size_t motor) const { return board_.current_measurable_A - std::fabs(offsets_.offset_A[motor]); }
  [[gnu::cold]] void follow_over_current(const Settings& settings);
  [[gnu::cold]] float test_limit_A(const Settings& settings) const;
  [[gnu::cold]] float test_voltage_V(const Settings& settings) const;
  void follow_test(protocol::Watches found, const Settings& settings);
  [[gnu::cold]] void drive_pulses(const Settings& settings);
  void supervise(const Samples& samples, const Settings& settings);
  void change_state(const Supervisor& next);

  BoardLimits board_;
  MeasuredMotors measured_;  ///< as pass_self_test() was told

  // Remembered from period to period.
  std::uint32_t periods_;
  CurrentOffsets offsets_;
  SupplyFilter supply_;
  SwitchFilter switches_;
  InkwellReference reference_;
  std::array<SpeedEstimate, 3> speeds_{};
  std::size_t turn_ = 0;  ///< of the joints, motors and gimbal angles, where one a period is enough
  std::array<CurrentLoop, 3> loops_{};
  MotorHeat heat_;
  std::array<Resistance, 3> resistances_{};
  MotorWatch motor_watch_;
  std::array<VoltageRange, 3> voltage_ranges_{};  ///< of the loops
  Triple over_current_A_{};                       ///< a measured current beyond it is a fault
  Triple over_current_for_A_{};                   ///< the limits of the settings for which it is settled, else 0
  std::uint32_t off_zero_periods_ = 0;            ///< in a row, while no bridge was on
  TestPulse test_;
  std::uint32_t self_tests_ = 0;
  Supervisor supervisor_;
  Situation asked_;                      ///< requests and faults from outside, since the period before
  protocol::Events lasting_events_ = 0;  ///< what is asked in every period
  bool force_is_on_ = false;
  Brake brake_;
  float force_gain_ = 0.0f;
  float force_limit_N_ = 0.0f;
  ProgramForce program_;
  bool world_changed_ = false;  ///< other shapes or settings than in the period before
  bool law_rendered_ = true;    ///< not while a program asked for its force instead
  Vector3 touched_N_;           ///< of law, shapes and transition, in the period before
  Transition transition_;
  EnergyReserve reserve_;
  std::uint32_t late_force_reports_ = 0;
  std::uint32_t host_silence_periods_ = 0;

  // Results of this period, in the order of the path.
  std::array<std::int32_t, 3> encoder_counts_{};  ///< since power-up
  std::uint32_t jump_bits_ = 0;                   ///< 0 unless one of them moved by more than an arm can
  std::array<std::int32_t, 3> counts_since_inkwell_{};
  Triple current_A_{};
  Probe probe_;  ///< what the force law is given
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

  // The large ones at the end, so that an instruction reaches all that is before them.
  TouchedShapes shapes_;
  FeltForceLaw law_;
  SelfTestPulses pulses_;
};

}  // namespace inkwell::control
