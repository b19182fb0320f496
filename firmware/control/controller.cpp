#include "firmware/control/controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

using protocol::Command;
using protocol::condition;
using protocol::Event;
using protocol::events;
using protocol::Fault;
using protocol::ForceMode;
using protocol::ForceSource;
using protocol::Limit;
using protocol::Signal;
using protocol::State;

std::uint8_t bit(ForceSource source, bool is_felt) {
  return is_felt ? static_cast<std::uint8_t>(source) : std::uint8_t{0};
}
std::uint8_t bit(Limit limit, bool is_reached) {
  return is_reached ? static_cast<std::uint8_t>(limit) : std::uint8_t{0};
}

bool over_current(const Triple& current_A, const Triple& limit_A) {
  for (std::size_t i = 0; i < 3; ++i)
    if (std::fabs(current_A[i]) > limit_A[i]) return true;
  return false;
}

/// A force with at least this fraction of the force limit counts as limited. Rounding may reduce a limited force by a
/// few millionths.
constexpr float at_limit_part = 1.0f - 1e-4f;

/// Decrease of the over-current bound per update. The bound falls from the largest limit to the smallest limit in 10
/// ms.
constexpr float over_current_fall_A = 0.06f;

bool joint_implausible(std::size_t joint, const Triple& joint_rad, Transmission transmission, const Limits& limits) {
  const float at_stop_rad = joint == 2 ? elbow_rad(joint_rad, transmission) : joint_rad[joint];
  return at_stop_rad < limits.joint_minimum_rad[joint] || at_stop_rad > limits.joint_maximum_rad[joint];
}

float sum(const Triple& values) { return values[0] + values[1] + values[2]; }
float sum(const Vector3& vector) { return vector.x + vector.y + vector.z; }

using Rows = protocol::EachAxis<Signal>;

void put(protocol::SignalValues& signals, Rows rows, const Triple& values) {
  for (std::size_t i = 0; i < 3; ++i) signals[rows[i]] = values[i];
}
void put(protocol::SignalValues& signals, Rows rows, const Vector3& vector) {
  put(signals, rows, Triple{vector.x, vector.y, vector.z});
}

}  // namespace

void Controller::carry_out(const protocol::CommandReport& command) {
  host_alive();
  switch (command.command) {
    case Command::enable_force: pending_.events |= events(Event::enable); break;
    case Command::disable_force:
      pending_.events |= events(Event::disable);
      test_.end();
      break;
    case Command::stop:  // also sent when the host disconnects
      pending_.events |= events(Event::stop);
      test_.end();
      break;
    case Command::clear_fault: pending_.events |= events(Event::clear); break;
    case Command::self_test: pending_.events |= events(Event::self_test); break;
    case Command::test_current:
    case Command::test_voltage:
      if (supervisor_.state == State::ready && !test_.runs())
        test_ = start_test_pulse(command.test, command.command == Command::test_current ? TestPulse::Quantity::current
                                                                                        : TestPulse::Quantity::voltage);
      break;
    case Command::heartbeat:
    case Command::select_signals:
    case Command::store_parameters:
    case Command::factory_reset: break;  // handled by the main loop
  }
}

void Controller::pass_self_test(const MeasuredMotors& measured) {
  pending_.events |= lasting_events_ = events(Event::tested);
  measured_ = measured;
}

void Controller::drive(const ForceTarget& target, const Settings& settings) {
  if (program_.set_target(target, settings.program_force)) ++late_force_reports_;
}

void Controller::replace_shapes(Shapes& shapes) {
  touch_.shapes.replace(shapes);
  world_changed_ = true;
}

void Controller::condition_samples(const Samples& samples, const Settings& settings) {
  // The bridges are off, so the current readings are the sensor offsets.
  if (!offsets_.measured()) {
    if (offsets_.periods == 0)
      for (std::size_t i = 0; i < 3; ++i) speeds_[i].start(samples.encoder_counts[i], periods_);
    offsets_.measure(samples.current_A);
    over_current_for_A_ = {};
  }
  switches_.debounce(samples.switches, turn_);
  supply_.add_sample(samples.supply_V);
  jump_bits_ = jumps(encoder_counts_, samples.encoder_counts, settings.encoders.jump_counts);
  encoder_counts_ = samples.encoder_counts;
  const auto take = [&](std::size_t i) { return replace(current_A_[i], samples.current_A[i] - offsets_.offset_A[i]); };
  const float first_A = take(0), second_A = take(1), third_A = take(2);
  if (is_large(first_A, second_A, third_A)) [[unlikely]]
    check_for_jumps({first_A, second_A, third_A}, settings);
  const float ratio = samples.gimbal_ratio[turn_];
  const GimbalCurve& curve = settings.gimbal[turn_];
  probe_.gimbal_rad[turn_] = (curve.square_rad * ratio + curve.slope_rad) * ratio + curve.offset_rad;
  heat_.update(turn_, current_A_[turn_], settings.heat);
  // While the force is on, a new inkwell reference would shift the walls relative to the hand.
  if (!force_is_on())
    reference_.update(encoder_counts_, protocol::is_closed(switches_.closed, protocol::Switch::inkwell));
}

/// This check uses the speed and the current errors of the previous period.
void Controller::check_for_jumps(const Triple& change_A, const Settings& settings) {
  // Fast current changes are normal during braking and directly after bridge switch-off.
  if (!drive_.enabled) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const float back_emf_V = settings.motor_model.back_emf_Vs_per_rad[i] * joint_speed_rad_per_s_[i];
    if (is_jump(change_A[i], loops_[i].error_A, back_emf_V, resistances_[i])) raise(Fault::current_jump);
  }
}

void Controller::find_pose(const Settings& settings) {
  constexpr auto periods_per_s = static_cast<float>(protocol::servo_rate_Hz);
  for (std::size_t i = 0; i < 3; ++i) {
    speeds_[i].update(encoder_counts_[i], periods_, i == turn_);
    joint_speed_rad_per_s_[i] = speeds_[i].counts_per_period * settings.encoders.rad_per_count[i] * periods_per_s;
    counts_since_inkwell_[i] = encoder_counts_[i] - reference_.counts[i];
  }
  turn_ = turn_ == 2 ? 0 : turn_ + 1;
  probe_.joint_rad = joint_angles(counts_since_inkwell_, settings.encoders);
  const auto [position_m, jacobian] = forward_kinematics(probe_.joint_rad, settings.arm);
  probe_.position_m = position_m;
  jacobian_ = jacobian;
  probe_.velocity_m_per_s = probe_velocity(jacobian_, joint_speed_rad_per_s_);
}

void Controller::render_force(const Settings& settings) {
  probe_.contact = find_contact(probe_.position_m, settings.box);
  program_.advance(settings.program_force);
  const bool object_expired = touch_.age();
  const bool world_changed = std::exchange(world_changed_, false) || object_expired;
  const bool law_rendered = program_.mode != ForceMode::instead_of_walls;
  const bool law_changed = std::exchange(law_rendered_, law_rendered) != law_rendered;
  const bool law_is_felt = force_is_on() && law_rendered;
  if (!law_is_felt) law_.reset();
  if (!force_is_on()) {
    touch_.release(probe_.position_m);
    force_ = {};
    limits_ = 0;
    force_gain_ = 0.0f;
    force_limit_N_ = settings.force_limit_N;
    rendered_N_ = {};
    transition_ = {};
    reserve_ = {settings.energy.reserve_J, probe_.position_m};
    return;
  }
  force_sources_ = bit(ForceSource::walls, law_rendered) | bit(ForceSource::shapes, touch_.has_objects()) |
                   bit(ForceSource::program, program_.is_driven());
  Vector3 rendered_N;
  probe_.wall = {settings.wall.stiffness_N_per_m, settings.wall.damping_Ns_per_m};
  if (touch_.has_objects()) {
    const bool may_touch_wall = law_is_felt && touch_.can_touch_wall(probe_.contact);
    const TouchForce& touch =
        touch_.step(probe_.position_m, probe_.velocity_m_per_s, may_touch_wall ? &settings.box : nullptr, settings.wall,
                    settings.contact_limit);
    reserve_.spend(touch.raised_J);
    rendered_N = touch.objects_N;
    probe_.walls_N = touch.walls_N;
  } else {
    touch_.release(probe_.position_m);
    probe_.walls_N = wall_force_N(probe_.contact, probe_.velocity_m_per_s, probe_.wall);
  }
  if (law_is_felt) {
    probe_.switches = switches_.closed;
    const Vector3& law_N = law_.force_N(probe_, settings.force_law);
    // The force limit computes the squared force, so the square must also be finite. Inputs that are not finite are not
    // a fault of the force law.
    if (is_finite(dot(law_N, law_N))) [[likely]]
      rendered_N = rendered_N + law_N;
    else if (is_finite(sum(probe_.position_m) + sum(probe_.velocity_m_per_s)))
      raise(Fault::force_law);
  }
  // The transition starts from the limited force, because only the limited force acted on the hand.
  if (world_changed || law_changed)
    transition_ =
        start_transition(bounded(rendered_N_, force_limit_N_).force_N - rendered_N, settings.recovery_N_per_period);
  rendered_N_ = rendered_N + transition_.force_N();
  transition_.advance();
  force_gain_ = supervisor_.state == State::landing ? std::max(force_gain_ - settings.landing_per_period, 0.0f)
                                                    : std::min(force_gain_ + settings.ramp_per_period, 1.0f);
  // A lowered force limit applies immediately. Missing and unknown motors must not receive a current.
  force_limit_N_ = measured_.awaits_motors
                       ? 0.0f
                       : std::min(force_limit_N_ + settings.recovery_N_per_period, settings.force_limit_N);
  const Force force = bounded(rendered_N_ + program_.force_N, force_limit_N_);
  limits_ = bit(Limit::force, force.magnitude_N >= at_limit_part * force_limit_N_ && force.magnitude_N > 0.0f) |
            bit(Limit::motors, measured_.awaits_motors);
  limit_and_apply_force(scaled(force, force_gain_), settings);
}

void Controller::limit_and_apply_force(Force requested, const Settings& settings) {
  reserve_.update(force_.force_N, probe_.position_m, settings.energy);
  const float power_W = dot(requested.force_N, probe_.velocity_m_per_s);
  const float speed_squared_m2_per_s2 = dot(probe_.velocity_m_per_s, probe_.velocity_m_per_s);
  if (power_W > 0.0f && (reserve_.is_low(settings.energy) || is_near(speed_squared_m2_per_s2, settings.speed)))
      [[unlikely]]
    requested = reduce_driving_part(requested, power_W, settings);
  const Vector3 change_N = requested.force_N - force_.force_N;
  const float squared_N2 = dot(change_N, change_N);
  if (squared_N2 > settings.change_squared_N2) [[unlikely]] {
    const float part = settings.change_squared_N2 * reciprocal_square_root(settings.change_squared_N2 * squared_N2);
    // A lowered force limit applies immediately.
    requested = bounded(force_.force_N + part * change_N, force_limit_N_);
    limits_ |= bit(Limit::change, true);
  }
  force_ = requested;
}

Force Controller::reduce_driving_part(const Force& requested, float power_W, const Settings& settings) {
  const float for_energy = reserve_.driving_reduction(settings.energy);
  const float for_speed = driving_reduction(dot(probe_.velocity_m_per_s, probe_.velocity_m_per_s), settings.speed);
  limits_ |= bit(Limit::energy, for_energy > 0.0f);
  limits_ |= bit(Limit::speed, for_speed > 0.0f);
  return bounded(without_drive(requested.force_N, power_W, probe_.velocity_m_per_s,
                               for_energy > for_speed ? for_energy : for_speed),
                 force_limit_N_);
}

void Controller::find_current_references(const Settings& settings) {
  torque_Nm_ = joint_torques(jacobian_, force_.force_N);
  // If one link motor is idle, the torque of the other link motor must be corrected.
  if (settings.motors.idle != 0) remove_idle_torque(settings.motors.idle, torque_Nm_, jacobian_);
  const CurrentReferences references = current_references(torque_Nm_, settings.motors, heat_.beyond);
  reference_A_ = references.reference_A;
  limits_ |= bit(Limit::current, references.held_by_current);
  limits_ |= bit(Limit::heat, references.held_by_heat);
  if (!test_.runs() || test_.quantity != TestPulse::Quantity::current) return;
  const float limit_A = std::min(settings.motors.allowed_A(test_.motor, heat_.beyond), test_limit_A(settings));
  reference_A_[test_.motor] = clamp(test_.value(), -limit_A, limit_A);
}

/// Updates the assumed resistance of one motor per period. The resistance depends on the motor heat.
void Controller::update_resistance(const Settings& settings) {
  resistances_[turn_] = Resistance::of(measured_.resistance_ohm[turn_], heat_.heat[turn_] - measured_.heat[turn_],
                                       settings.motor_model.resistance_ohm[turn_]);
}

void Controller::check_motors(const Settings& settings) {
  // While the force is on, the resistance is updated only when the heat is updated.
  if (!force_is_on() || heat_.readings == 0) update_resistance(settings);
  if (!force_is_on() || measured_.awaits_motors) {
    motor_check_.reset();
    check_idle_currents();
    return;
  }
  if (!motor_check_.update(current_A_, joint_speed_rad_per_s_, resistances_, settings.motor_model.back_emf_Vs_per_rad))
      [[unlikely]]
    raise(Fault::motor_implausible);
  // The bridges apply the duty cycles of the previous period.
  motor_check_.turn_to(
      turn_, drive_.duty[turn_] * supply_.supply_V,
      {measured_.bridge_loss_part[turn_] * supply_.supply_V, board_.dead_time_part * supply_.supply_V});
}

/// If a current sensor reads too low, the current loop drives too much current. The voltage range therefore allows at
/// most the reference current plus a margin. The margin is the current for the difference between force limit and
/// present force. Each period updates the voltage range of one motor.
void Controller::bound_voltages(const Settings& settings) {
  const float supply_bound_V = board_.duty_limit * supply_.supply_V;
  const float bound_V = clamp(settings.current_loop.voltage_limit_V, 0.0f, supply_bound_V);
  if (!force_is_on()) {
    voltage_ranges_.fill({-bound_V, bound_V});
    return;
  }
  const float left_N = force_limit_N_ - force_.magnitude_N;
  const float most_A = std::fabs(reference_A_[turn_]) + left_N * settings.motors.ampere_per_N[turn_];
  const float back_emf_V = settings.motor_model.back_emf_Vs_per_rad[turn_] * joint_speed_rad_per_s_[turn_];
  voltage_ranges_[turn_] =
      voltage_range(most_A, resistances_[turn_], back_emf_V, motor_check_.loss.expected_V(), bound_V);
}

/// While the bridges are off, each current sensor must read its measured offset.
void Controller::check_idle_currents() {
  bool off_zero = false;
  if (!drive_.enabled && !drive_.brake && offsets_.measured())
    for (const float each_A : current_A_) off_zero = off_zero || !(std::fabs(each_A) <= CurrentOffsets::plausible_A);
  off_zero_periods_ = off_zero ? off_zero_periods_ + 1 : 0;
  if (off_zero_periods_ >= CurrentOffsets::patience_periods) raise(Fault::current_sensor);
}

void Controller::regulate_currents(const Settings& settings) {
  check_motors(settings);
  bound_voltages(settings);
  drive_ = {};
  if (!force_is_on() && !test_.runs()) {
    loops_ = {};
    if (pulses_.runs()) [[unlikely]]
      drive_pulses(settings);
    return;
  }
  if (force_is_on() && measured_.awaits_motors) {
    loops_ = {};
    drive_.enabled = true;  // with the duty 0
    return;
  }
  // A motor in a voltage test has no current loop.
  constexpr std::size_t none = 3;
  const bool is_voltage_test = test_.runs() && test_.quantity == TestPulse::Quantity::voltage;
  const std::size_t without_loop = is_voltage_test ? test_.motor : none;
#pragma GCC unroll 1  // unrolled code does not fit into the interrupt memory
  for (std::size_t i = 0; i < 3; ++i) {
    CurrentLoopStep step =
        regulate(loops_[i], reference_A_[i], current_A_[i], settings.current_loop, voltage_ranges_[i]);
    if (i == without_loop) [[unlikely]]
      step = {{}, clamp(test_voltage_V(settings), voltage_ranges_[i].least_V, voltage_ranges_[i].most_V)};
    loops_[i] = step.loop;
    drive_.duty[i] = step.voltage_V * supply_.per_V;  // limited by the range and by the bridges
  }
  drive_.enabled = true;
}

/// The limits of the rendered force do not apply to a motor test. A motor test stops if the arm is too fast or if no
/// host report arrives. A motor test stops when it has used up the energy reserve.
void Controller::follow_test(protocol::Conditions found, const Settings& settings) {
  constexpr protocol::Conditions ends = condition(Fault::over_speed) | condition(Fault::host_silent);
  if ((found & ends).any()) {
    test_.end();
    drive_ = {};
    return;
  }
  --test_.remaining_periods;
  // The product of back EMF and current is the mechanical power. The magnitude of the power is integrated, because the
  // signs of motor and encoder may still be wrong.
  const float back_emf_V = settings.motor_model.back_emf_Vs_per_rad[test_.motor] * joint_speed_rad_per_s_[test_.motor];
  test_.moved_J += std::fabs(back_emf_V * current_A_[test_.motor]) * protocol::servo_period_s;
  if (test_.moved_J > settings.energy.reserve_J) test_.end_pulse();
}

/// Compares one joint angle per period with the joint angle in the inkwell. The supervisor ignores inkwell_implausible
/// while the arm is not referenced.
void Controller::check_inkwell_switch(const Settings& settings) {
  if (std::fabs(probe_.joint_rad[turn_] - settings.encoders.inkwell_rad[turn_]) > settings.limits.inkwell_play_rad)
    raise(Fault::inkwell_implausible);
}

// The over-current bound falls slowly, because the current needs time to follow a lowered limit.
void Controller::follow_over_current(const Settings& settings) {
  const float limit_A = settings.limits.over_current_A[turn_];
  over_current_A_[turn_] = std::min(std::max(limit_A, over_current_A_[turn_] - over_current_fall_A), known_A(turn_));
  over_current_for_A_[turn_] = over_current_A_[turn_] <= limit_A ? limit_A : 0.0f;
}

float Controller::test_limit_A(const Settings& settings) const {
  return control::test_limit_A(jacobian_, test_.motor, settings.force_limit_N,
                               settings.motors.ampere_per_Nm[test_.motor]);
}

// The motor resistance may be unknown in a voltage test, so the current limit is checked in each period.
float Controller::test_voltage_V(const Settings& settings) const {
  return std::fabs(current_A_[test_.motor]) > test_limit_A(settings) ? 0.0f : test_.value();
}

void Controller::drive_pulses(const Settings& settings) {
  const Triple voltage_V = pulses_.step(current_A_, encoder_counts_,
                                        {.current_limit_A = settings.motors.current_limit_A,
                                         .supply_V = supply_.supply_V,
                                         .dead_time_part = board_.dead_time_part});
  for (std::size_t i = 0; i < 3; ++i) {
    drive_.duty[i] = clamp(voltage_V[i] * supply_.per_V, -board_.duty_limit, board_.duty_limit);
    // The pulse current must not cause the over-current fault.
    over_current_A_[i] = std::min(std::max(settings.limits.over_current_A[i], SelfTestPulses::maximum_A), known_A(i));
  }
  over_current_for_A_ = {};                       // restarts follow_over_current()
  over_current_A_[turn_] += over_current_fall_A;  // follow_over_current() subtracts this step in this period
  drive_.enabled = true;
}

void Controller::supervise(const Samples& samples, const Settings& settings) {
  ++host_silence_periods_;
  if (over_current_for_A_[turn_] != settings.limits.over_current_A[turn_]) [[unlikely]]
    follow_over_current(settings);
  if (protocol::is_closed(switches_.closed, protocol::Switch::inkwell)) [[unlikely]]
    check_inkwell_switch(settings);
  const float speed_squared_m2_per_s2 = dot(probe_.velocity_m_per_s, probe_.velocity_m_per_s);
  // The check of the current references includes force and torques.
  const float sum_of_all = sum(probe_.position_m) + speed_squared_m2_per_s2 + sum(reference_A_) + sum(current_A_) +
                           sum(drive_.duty) + supply_.supply_V;
  protocol::Conditions found = pending_.found | condition(Fault::bridge_fault, samples.bridge_fault) |
                               condition(Fault::motor_hot, heat_.too_hot);
  protocol::Events now = pending_.events;
  // Branches need half the cycles of unconditional bit operations.
  const auto find = [&found](Fault fault, bool is_there) {
    if (is_there) [[unlikely]]
      found |= condition(fault);
  };
  const auto note = [&now](Event event, bool is_so) {
    if (is_so) now |= events(event);
  };
  find(Fault::not_finite, !is_finite(sum_of_all));
  if (offsets_.measured()) [[likely]] {
    now |= events(Event::measured);
    find(Fault::current_sensor, !offsets_.plausible);
  }
  find(Fault::samples_stale, !samples.currents_measured || samples.slow_age_periods > SupplyFilter::stale_periods);
  find(Fault::supply_low, supply_.supply_V < board_.supply_minimum_V || samples.supply_V < board_.supply_far_too_low_V);
  find(Fault::supply_high,
       supply_.supply_V > board_.supply_maximum_V || samples.supply_V > board_.supply_far_too_high_V);
  find(Fault::over_current, over_current(current_A_, over_current_A_));
  find(Fault::encoder_implausible,
       jump_bits_ != 0 || joint_implausible(turn_, probe_.joint_rad, settings.arm.transmission, settings.limits));
  find(Fault::over_speed, speed_squared_m2_per_s2 > settings.limits.speed_limit_squared_m2_per_s2);
  find(Fault::host_silent, host_silence_periods_ > settings.limits.host_timeout_periods);
  note(Event::referenced, reference_.valid);
  note(Event::risen, force_gain_ == 1.0f);
  note(Event::landed, force_gain_ == 0.0f);
  note(Event::held_back, limits_ != 0);
  // Faults with voids_reference invalidate the inkwell reference, even while another fault is active.
  if ((found & protocol::voiding_conditions).any() && reference_.valid) [[unlikely]]
    reference_.forget((found & condition(Fault::inkwell_implausible)).any());
  if (!stays_unchanged(supervisor_.state, {now, found})) [[unlikely]]
    change_state(advance(supervisor_, {now, found}));
  pending_ = {.events = lasting_events_};
  if (test_.runs()) [[unlikely]]
    follow_test(found, settings);
  if (brake_.is_on()) [[unlikely]] {
    brake_.advance(speed_squared_m2_per_s2, found);
    drive_.brake = brake_.shorts(current_A_, settings.limits.brake_A);
  }
}

void Controller::change_state(const Supervisor& next) {
  const Supervisor before = std::exchange(supervisor_, next);
  if (next == before) return;
  const bool force_was_on = std::exchange(force_is_on_, protocol::force_is_on(next.state));
  if (force_is_on_) off_zero_periods_ = 0;
  // The bridges must switch off in the period of the state change.
  if (!(force_was_on && force_is_on_)) {
    drive_ = {};
    force_sources_ = 0;
  }
  if (next.state != State::ready) test_.end();
  pulses_.stop();
  if (next.state == State::testing) {
    ++self_tests_;
    lasting_events_ = {};
  }
  if (force_was_on && next.state == State::fault)
    brake_.begin();
  else
    brake_ = {};
}

void Controller::write_signals(protocol::SignalValues& signals) const {
  const auto& counts = counts_since_inkwell_;
  put(signals, Signal::encoder_1_counts,
      Triple{static_cast<float>(counts[0]), static_cast<float>(counts[1]), static_cast<float>(counts[2])});
  put(signals, Signal::joint_1_rad, probe_.joint_rad);
  put(signals, Signal::position_x_m, probe_.position_m);
  put(signals, Signal::velocity_x_m_s, probe_.velocity_m_per_s);
  put(signals, Signal::penetration_x_m, probe_.contact.penetration_m);
  put(signals, Signal::force_x_N, force_.force_N);
  signals[Signal::force_N] = force_.magnitude_N;
  put(signals, Signal::torque_1_Nm, torque_Nm_);
  put(signals, Signal::current_reference_1_A, reference_A_);
  put(signals, Signal::current_1_A, current_A_);
  put(signals, Signal::duty_1, drive_.duty);
  put(signals, Signal::gimbal_1_rad, probe_.gimbal_rad);
  put(signals, Signal::joint_speed_1_rad_s, joint_speed_rad_per_s_);
  put(signals, Signal::motor_heat_1, heat_.heat);
  put(signals, Signal::program_force_x_N, program_.force_N);
  signals[Signal::force_sources] = force_sources_;
  signals[Signal::limits] = limits_;
  signals[Signal::supply_V] = supply_.supply_V;
  signals[Signal::servo_cycles] = static_cast<float>(servo_cycles_);
  static constexpr Signal cycles_of_stage[stage_count] = {Signal::stage_sample_cycles,  Signal::stage_pose_cycles,
                                                          Signal::stage_contact_cycles, Signal::stage_torque_cycles,
                                                          Signal::stage_current_cycles, Signal::stage_report_cycles};
  for (std::size_t i = 0; i < stage_count; ++i) signals[cycles_of_stage[i]] = static_cast<float>(cycles_[i]);
  for (std::size_t i = 0; i < force_law_signal_count; ++i) signals.values[protocol::signal_count + i] = law_.signal(i);
}

}  // namespace inkwell::control
