#include "boards/virtual/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inkwell::virtual_board {
namespace {

using protocol::Parameter;

static_assert(ticks_per_s % 60'000 == 0, "the mechanical step must be exact");

Vector3 inkwell_joints_rad(const arms::Description& arm) {
  const auto joints_rad = arm.parameters.of_each(Parameter::inkwell_joint_1_rad);
  return {joints_rad[0], joints_rad[1], joints_rad[2]};
}

MotorConstants with_shunt(const arms::Description& arm, const board::Facts& board, unsigned motor) {
  return {static_cast<double>(arm.parameters[of_axis(Parameter::motor_resistance_1_ohm, motor)] + board.shunt_ohm),
          arm.motor.inductance_H};
}

MotorDrive motor_drive(const arms::Description& arm, const board::Facts& board, unsigned motor,
                       const Imperfections& imperfections) {
  return {with_shunt(arm, board, motor), imperfections, static_cast<double>(board.bridge_dead_time_s)};
}

double healthy_torque_per_A(const arms::Description& arm, unsigned motor) {
  const auto& p = arm.parameters;
  const double sign = p[of_axis(Parameter::motor_1_reversed, motor)] == 1.0f ? -1.0 : 1.0;
  return sign * static_cast<double>(p[of_axis(Parameter::gear_ratio_1, motor)]) *
         static_cast<double>(p[of_axis(Parameter::torque_constant_1_Nm_per_A, motor)]);
}

QuadratureEncoder encoder(const arms::Description& arm, unsigned motor, std::uint64_t seed) {
  const auto& p = arm.parameters;
  const double sign = p[of_axis(Parameter::encoder_1_reversed, motor)] == 1.0f ? -1.0 : 1.0;
  const double counts_per_rad = static_cast<double>(p[of_axis(Parameter::gear_ratio_1, motor)]) *
                                static_cast<double>(p[of_axis(Parameter::encoder_1_counts_per_turn, motor)]) /
                                (2.0 * std::numbers::pi);
  return QuadratureEncoder(sign * counts_per_rad, inkwell_joints_rad(arm)[motor], 3 * seed + motor);
}

std::array<double, 3> gimbal_terms(const arms::Description& arm, unsigned axis) {
  const auto& p = arm.parameters;
  return {p[of_axis(Parameter::gimbal_1_square_rad, axis)], p[of_axis(Parameter::gimbal_1_slope_rad, axis)],
          p[of_axis(Parameter::gimbal_1_offset_rad, axis)]};
}

constexpr double reference_V = static_cast<double>(board::adc_reference_V);

/// Resistance of the supply voltage divider at the pin.
double divider_ohm(const board::Facts& board) {
  return static_cast<double>(board.supply_upper_ohm / board.supply_divider());
}

PinLevel level_of(bool high) { return high ? PinLevel::high : PinLevel::low; }
/// The pull-up in the chip provides the high level.
PinLevel contact(bool closed) { return closed ? PinLevel::low : PinLevel::floating; }
/// The fault wire is open-drain, and a pull-up on the board provides the high level.
PinLevel fault_wire(bool fault) { return fault ? PinLevel::low : PinLevel::high; }

}  // namespace

Plant::Plant(const arms::Description& arm, const board::Facts& board, const PlantOptions& options)
    : board_(board),
      imperfections_(options.imperfections),
      motors_{motor_drive(arm, board, 0, imperfections_), motor_drive(arm, board, 1, imperfections_),
              motor_drive(arm, board, 2, imperfections_)},
      hold_(ticks(static_cast<double>(board.bridge_hold_s))),
      supply_(imperfections_, static_cast<double>(board::supply_nominal_V)),
      supply_divided_V_(supply_.bus_V() / static_cast<double>(board.supply_divider())),
      analog_supply_V_(reference_V),
      windings_{with_shunt(arm, board, 0), with_shunt(arm, board, 1), with_shunt(arm, board, 2)},
      torque_per_A_{healthy_torque_per_A(arm, 0), healthy_torque_per_A(arm, 1), healthy_torque_per_A(arm, 2)},
      arm_(arm, inkwell_joints_rad(arm)),
      probe_m_(arm_.dynamics().position_m(arm_.joints_rad())),
      inkwell_(probe_m_, true),
      encoders_{encoder(arm, 0, options.seed), encoder(arm, 1, options.seed), encoder(arm, 2, options.seed)},
      gimbal_terms_{gimbal_terms(arm, 0), gimbal_terms(arm, 1), gimbal_terms(arm, 2)},
      divider_follows_(
          1.0 - std::exp(-seconds(step_ticks) / (divider_ohm(board) * static_cast<double>(board.supply_filter_F)))),
      random_(options.seed) {
  for (auto& legs : leg_pins_) legs.fill(PinLevel::floating);
  const auto wire = [&](board::Pin pin, Role role, unsigned motor) {
    wires_[wire_index(pin.port, pin.number)] = {role, static_cast<std::uint8_t>(motor)};
  };
  for (unsigned i = 0; i < 3; ++i) {
    wire(board_.bridges[i].leg_a.pin, Role::leg_a, i);
    wire(board_.bridges[i].leg_b.pin, Role::leg_b, i);
    motors_[i].set_bus_V(supply_.bus_V());
    // Initially the wipers are in the middle of their tracks.
    const auto& [square, slope, offset] = gimbal_terms_[i];
    gimbal_rad_[i] = 0.25 * square + 0.5 * slope + offset;
  }
  wire(board_.bridge_enable, Role::enable, 0);
  wire(board_.bridge_heartbeat, Role::heartbeat, 0);
}

void Plant::connect(InputPins& pins) {
  pins_ = &pins;
  for (unsigned i = 0; i < 3; ++i) {
    encoder_levels_[i] = QuadratureEncoder::levels(encoders_[i].shown());
    pins.drive(board_.encoders[i].a.pin.port, board_.encoders[i].a.pin.number, level_of(encoder_levels_[i].a));
    pins.drive(board_.encoders[i].b.pin.port, board_.encoders[i].b.pin.number, level_of(encoder_levels_[i].b));
  }
  inputs_stale_ = true;
  shown_.fill(PinLevel::floating);  // level of an undriven pin
  show_inputs();
  show_hold();
}

// ---- calls from the chip --------------------------------------------------------------------------------

void Plant::output_changed(char port, unsigned pin, PinLevel level, Ticks now) {
  const unsigned index = wire_index(port, pin);
  if (index >= wires_.size() || wires_[index].role == Role::none) return;
  run_until(now);
  const Wire wire = wires_[index];
  if (wire.role == Role::enable || wire.role == Role::heartbeat) {
    const bool high = level == PinLevel::high;  // the board's pull-downs set floating pins low
    wire.role == Role::enable ? hold_.drive_clear(high, now) : hold_.drive_trigger(high, now);
    enable_bridges(hold_.ends_at() > now, now);
    return;
  }
  leg_pins_[wire.motor][wire.role == Role::leg_a ? 0 : 1] = level;
  update_legs(wire.motor, now);
  note_driving(now);
}

void Plant::enable_bridges(bool enabled, Ticks now) {
  if (enabled == bridges_enabled_) return;
  bridges_enabled_ = enabled;
  if (!enabled) tripped_ = false;
  show_hold();
  for (unsigned i = 0; i < 3; ++i) update_legs(i, now);
  note_driving(now);
}

/// Disables the bridges if the pulse of the monostable has ended at `until`.
void Plant::let_go_of_bridges(Ticks until) {
  if (bridges_enabled_ && hold_.ends_at() <= until) enable_bridges(false, hold_.ends_at());
}

void Plant::note_driving(Ticks now) {
  const bool on = bridges_enabled_ && !bridge_fault_ && !tripped_;
  bool drives = false;
  for (const auto& legs : leg_pins_)
    for (const PinLevel level : legs) drives |= on && level == PinLevel::high;
  if (driving_ && !drives) driven_until_ = now;
  driving_ = drives;
}

bool Plant::shoots_through() const {
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned leg = 0; leg < 2; ++leg) {
      const bool high = leg_pins_[i][leg] == PinLevel::high;
      if (leg_faults_[i][leg] == (high ? LegFault::low : LegFault::high)) return true;
    }
  return false;
}

void Plant::update_legs(unsigned motor, Ticks now) {
  if (bridges_enabled_ && !tripped_ && shoots_through()) {
    // A shoot-through trips the bridge within microseconds, and the bridge reports a fault.
    tripped_ = inputs_stale_ = true;
    for (unsigned i = 0; i < 3; ++i) update_legs(i, now);
    return;
  }
  for (unsigned leg = 0; leg < 2; ++leg) {
    // In a disabled or tripped bridge only the diodes conduct. The bridge inputs have pull-downs, so a floating pin is
    // low.
    const bool off = !bridges_enabled_ || bridge_fault_ || tripped_;
    motors_[motor].set_leg(leg,
                           off                                       ? Leg::floating
                           : leg_pins_[motor][leg] == PinLevel::high ? Leg::high
                                                                     : Leg::low,
                           now);
  }
}

double Plant::shunt_V(unsigned motor) {
  const double lower_V = static_cast<double>(board_.shunt_amplifier_headroom_V);
  const double upper_V = std::max(lower_V, analog_supply_V_ - lower_V);
  const double V_per_A = static_cast<double>(board_.shunt_V_per_A());
  const ShuntFault& fault = shunt_faults_[motor];
  const double volts =
      0.5 * analog_supply_V_ + imperfections_.amplifier_offset_V[motor] +
      V_per_A * (1.0 + imperfections_.amplifier_gain_error[motor]) * fault.read_A(motors_[motor].amplifier_A()) +
      noise(imperfections_.amplifier_noise_V);
  switch (fault.output) {
    case ShuntFault::Output::upper_rail: return upper_V;
    case ShuntFault::Output::lower_rail: return lower_V;
    case ShuntFault::Output::frozen: return fault.frozen_V;
    case ShuntFault::Output::follows: break;
  }
  return std::clamp(volts, lower_V, upper_V);
}

double Plant::analog_V(char port, unsigned pin, Ticks now) {
  const board::Pin wanted{port, static_cast<std::uint8_t>(pin)};
  run_until(now);
  for (unsigned i = 0; i < 3; ++i) {
    if (board_.motor_current[i].pin == wanted) {
      motors_[i].advance(now);
      return shunt_V(i);
    }
    if (board_.gimbal[i].pin == wanted)
      return std::clamp(gimbal_V(i) + noise(imperfections_.wiper_noise_V), 0.0, analog_supply_V_);
  }
  if (board_.supply.pin == wanted)
    return std::clamp(supply_divided_V_ + noise(imperfections_.supply_reading_noise_V), 0.0, analog_supply_V_);
  return 0.0;  // unwired pin, coupled to the ground plane
}

AnalogSource Plant::analog_source(char port, unsigned pin) const {
  const board::Pin wanted{port, static_cast<std::uint8_t>(pin)};
  for (unsigned i = 0; i < 3; ++i) {
    if (board_.motor_current[i].pin == wanted)
      return {board_.current_filter_ohm, board_.current_filter_F, board_.current_pull_down_ohm};
    // The source resistance of the wiper is largest in the middle of the track.
    if (board_.gimbal[i].pin == wanted) return {board_.gimbal_track_ohm / 4, board_.gimbal_filter_F};
  }
  if (board_.supply.pin != wanted) return {};
  return {divider_ohm(board_), board_.supply_filter_F, board_.supply_lower_ohm};
}

double Plant::gimbal_V(unsigned axis) {
  // Solves angle = square r^2 + slope r + offset for the ratio r between 0 and 1.
  const auto& [square, slope, offset] = gimbal_terms_[axis];
  const double constant = offset - gimbal_rad_[axis];
  double ratio = -constant / slope;
  if (square != 0.0) {
    const double root = std::sqrt(std::max(slope * slope - 4.0 * square * constant, 0.0));
    ratio = -2.0 * constant / (slope + std::copysign(root, slope));  // the root that is finite for square = 0
  }
  return std::clamp(ratio, 0.0, 1.0) * analog_supply_V_;
}

void Plant::advance(Ticks now) {
  run_until(now);
  show_inputs();
}

// ---- time ----------------------------------------------------------------------------------------------

void Plant::run_until(Ticks now) {
  while (next_step_ <= now) {
    let_go_of_bridges(next_step_);
    step();
    next_step_ += step_ticks;
  }
  let_go_of_bridges(now);
  now_ = std::max(now_, now);
}

void Plant::step() {
  constexpr double duration_s = seconds(step_ticks);
  double supply_charge_As = 0.0;
  for (unsigned i = 0; i < 3; ++i) {
    motors_[i].advance(next_step_);
    const auto charges = motors_[i].take_charges();
    torque_Nm_[i] = torque_per_A(i) * charges.motor_As / duration_s;
    supply_charge_As += charges.supply_As;
  }
  const std::array<Coupling, 3> couplings = {hand_.coupling(next_step_), carrier_.coupling(next_step_),
                                             inkwell_.coupling()};
  arm_.step(duration_s, torque_Nm_, couplings);
  const Vector3 before_m = probe_m_;
  probe_m_ = arm_.dynamics().position_m(arm_.joints_rad());
  static_assert(MotorForceMeter::steps_per_period * step_ticks == ticks_per_s / board::servo_rate_Hz);
  static_assert(MotorForceMeter::steps_per_ms * step_ticks == ticks_per_s / 1000);
  if (hand_meter_.runs()) {
    const bool is_driven = driving_ || next_step_ < driven_until_ + MotorForceMeter::steps_per_period * step_ticks;
    motor_force_meter_.step(torque_Nm_, arm_.dynamics().jacobian_m(arm_.joints_rad()), is_driven);
    if (hand_.holds())
      hand_meter_.step(probe_m_, couplings[0].target_m,
                       -couplings[0].force_N(probe_m_, (probe_m_ - before_m) / duration_s));
  }
  inputs_stale_ = true;
  inkwell_.advance(duration_s, probe_m_);
  if (carrier_.holds()) finish_docking();
  supply_.advance(duration_s, supply_charge_As);
  supply_divided_V_ +=
      (supply_.bus_V() / static_cast<double>(board_.supply_divider()) - supply_divided_V_) * divider_follows_;
  for (unsigned i = 0; i < 3; ++i) {
    motors_[i].set_back_emf_V(torque_per_A(i) * arm_.joint_speeds_rad_s()[i]);
    motors_[i].set_bus_V(supply_.bus_V());
  }
}

void Plant::finish_docking() {
  // The inkwell captures the stylus only at the end of the hand's path.
  if (carrier_.is_moving(next_step_)) return;
  if (inkwell_.capture(probe_m_)) carrier_.release();
}

// ---- the chip's inputs -----------------------------------------------------------------------------------

void Plant::show(char port, unsigned pin, PinLevel level, PinLevel& shown) {
  if (level == shown) return;
  shown = level;
  pins_->drive(port, pin, level);
}

/// The bridge enable pin is driven immediately, because the chip measures the pulse duration of the monostable.
void Plant::show_hold() {
  if (pins_ != nullptr) show(board_.bridge_hold.port, board_.bridge_hold.number, level_of(bridges_enabled_), shown_[6]);
}

void Plant::show_inputs() {
  if (pins_ == nullptr || !inputs_stale_) return;
  inputs_stale_ = false;
  // Edge times assume that the arm has moved at constant speed since the inputs were last driven.
  const Ticks from = shown_at_, to = next_step_ - step_ticks;
  shown_at_ = to;
  for (unsigned i = 0; i < 3; ++i) {
    const auto& wiring = board_.encoders[i];
    encoders_[i].follow(arm_.joints_rad()[i], [&](QuadratureEncoder::Levels levels, double share) {
      const Ticks when = from + static_cast<Ticks>(share * static_cast<double>(to - from));
      // Adjacent counts differ in one encoder output, so one call per count drives the changed pin.
      const auto& changed = levels.a != encoder_levels_[i].a ? wiring.a.pin : wiring.b.pin;
      pins_->drive(changed.port, changed.number, level_of(&changed == &wiring.a.pin ? levels.a : levels.b), when);
      encoder_levels_[i] = levels;
    });
  }
  const bool inkwell_closed = inkwell_.switch_closed(probe_m_);
  show(board_.button_1.port, board_.button_1.number, contact(buttons_[0]), shown_[0]);
  show(board_.button_2.port, board_.button_2.number, contact(buttons_[1]), shown_[1]);
  show(board_.inkwell_switch.port, board_.inkwell_switch.number, contact(inkwell_closed), shown_[2]);
  show(board_.bridge_fault_tim1.pin.port, board_.bridge_fault_tim1.pin.number, fault_wire(bridge_fault_ || tripped_),
       shown_[3]);
  show(board_.bridge_fault_tim8.pin.port, board_.bridge_fault_tim8.pin.number, fault_wire(bridge_fault_ || tripped_),
       shown_[4]);
  show(board_.usb_supply.port, board_.usb_supply.number, level_of(usb_supply_), shown_[5]);
}

// ---- user actions ---------------------------------------------------------------------------------------

void Plant::press_buttons(bool first, bool second) {
  buttons_ = {first, second};
  inputs_stale_ = true;
}

void Plant::set_bridge_fault(bool fault) {
  bridge_fault_ = fault;
  inputs_stale_ = true;
  for (unsigned i = 0; i < 3; ++i) update_legs(i, now_);
  note_driving(now_);
}

void Plant::set_shunt_fault(unsigned motor, const ShuntFault& fault) {
  motors_[motor].advance(now_);
  const double now_V = shunt_V(motor);
  shunt_faults_[motor] = fault;
  shunt_faults_[motor].frozen_V = now_V;
}

void Plant::set_motor_fault(unsigned motor, const MotorFault& fault) {
  motor_faults_[motor] = fault;
  const double shunt_ohm = static_cast<double>(board_.shunt_ohm);
  std::optional<MotorConstants> left;
  if (!fault.open)
    left = MotorConstants{(windings_[motor].resistance_ohm - shunt_ohm) * fault.resistance_factor() + shunt_ohm,
                          windings_[motor].inductance_H * fault.inductance_factor()};
  motors_[motor].set_winding(left, now_);
}

void Plant::set_leg_fault(unsigned motor, unsigned leg, LegFault fault) {
  leg_faults_[motor][leg] = fault;
  motors_[motor].set_leg_fault(leg, fault, now_);
  update_legs(motor, now_);
  note_driving(now_);
}

void Plant::set_usb_supply(bool present) {
  usb_supply_ = present;
  inputs_stale_ = true;
}

void Plant::hold(const Vector3& target_m, double stiffness_N_per_m, double damping_Ns_per_m) {
  carrier_.release();
  hand_.hold(target_m, stiffness_N_per_m, damping_Ns_per_m);
}

void Plant::let_go() { hand_.release(); }

void Plant::follow(const std::vector<Waypoint>& waypoints) {
  carrier_.release();
  hand_.follow(waypoints, probe_m_, now_);
}

void Plant::dock(bool docked) {
  carrier_.release();
  if (!docked) {
    inkwell_.eject();
    return;
  }
  hand_.release();
  if (inkwell_.seated()) return;
  constexpr double speed_m_s = 0.2;
  constexpr double shortest_s = 0.1;
  constexpr double stiffness_N_per_m = 800.0;  // sags under the arm's weight by less than the funnel's radius
  constexpr double damping_Ns_per_m = 8.0;
  const double distance_m = (inkwell_.position_m() - probe_m_).norm();
  carrier_.hold(probe_m_, stiffness_N_per_m, damping_Ns_per_m);
  carrier_.follow({{std::max(shortest_s, distance_m / speed_m_s), inkwell_.position_m()}}, probe_m_, now_);
}

void Plant::place(const Vector3& joints_rad, const Vector3& joint_speeds_rad_s) {
  carrier_.release();
  inkwell_.eject();
  arm_.place(joints_rad, joint_speeds_rad_s);
  probe_m_ = arm_.dynamics().position_m(joints_rad);
  inputs_stale_ = true;
}

Truth Plant::truth(Ticks now) {
  run_until(now);
  // Positions are extrapolated from the last step with the speed of the arm.
  const double since_step_s = seconds(now_ + step_ticks - next_step_);
  Truth t;
  t.at = now_;
  t.joint_speeds_rad_s = arm_.joint_speeds_rad_s();
  t.joints_rad = arm_.joints_rad() + since_step_s * t.joint_speeds_rad_s;
  const auto terms = arm_.dynamics().terms(t.joints_rad, t.joint_speeds_rad_s);
  t.position_m = terms.position_m;
  t.velocity_m_s = terms.jacobian_m * t.joint_speeds_rad_s;
  for (unsigned i = 0; i < 3; ++i) {
    motors_[i].advance(now_);
    t.current_A[i] = motors_[i].current_A();
    t.torque_Nm[i] = torque_per_A(i) * t.current_A[i];
    t.encoder_counts[i] = encoders_[i].count_at(arm_.joints_rad()[i]);
  }
  const Coupling hand = hand_.coupling(now_);
  t.hand_holds = hand_.holds();
  t.hand_force_N = hand.force_N(t.position_m, t.velocity_m_s);
  t.hand_target_m = t.hand_holds ? hand.target_m : t.position_m;
  t.supply_V = supply_.bus_V();
  t.docked = inkwell_.seated();
  t.inkwell_switch = inkwell_.switch_closed(t.position_m);
  t.bridge_fault = bridge_fault_ || tripped_;
  t.buttons = buttons_;
  t.bridges_enabled = bridges_enabled_;
  t.driven_until = driving_ ? now_ : driven_until_;
  t.leg_levels = leg_pins_;
  return t;
}

}  // namespace inkwell::virtual_board
