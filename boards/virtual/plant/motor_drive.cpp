#include "boards/virtual/plant/motor_drive.hpp"

#include <cmath>
#include <numbers>

namespace inkwell::virtual_board {

MotorDrive::MotorDrive(const MotorConstants& motor, const Imperfections& imperfections, double dead_time_s)
    : legs_ohm_(2.0 * imperfections.leg_resistance_ohm),
      amplifier_s_(1.0 / (2.0 * std::numbers::pi * imperfections.amplifier_bandwidth_Hz)),
      diode_drop_V_(imperfections.diode_drop_V),
      dead_time_(ticks(dead_time_s)) {
  configure(motor);
}

void MotorDrive::configure(const MotorConstants& motor) {
  resistance_ohm_ = motor.resistance_ohm + legs_ohm_;
  time_constant_s_ = motor.inductance_H / resistance_ohm_;
  inverse_resistance_ = 1.0 / resistance_ohm_;
  amplifier_time_constant_s_ = amplifier_s_;
  // The closed form is singular if amplifier and winding have equal time constants. A ratio close to 1 is therefore set
  // to 0.999.
  double ratio = amplifier_time_constant_s_ / time_constant_s_;
  if (std::abs(1.0 - ratio) < 1e-3) {
    ratio = 1.0 - 1e-3;
    amplifier_time_constant_s_ = ratio * time_constant_s_;
  }
  amplifier_lead_ = 1.0 / (1.0 - ratio);
  dead_time_decay_ = std::exp(-seconds(dead_time_) / time_constant_s_);
  dead_time_amplifier_decay_ = std::exp(-seconds(dead_time_) / amplifier_time_constant_s_);
}

void MotorDrive::set_winding(const std::optional<MotorConstants>& motor, Ticks now) {
  advance(now);
  conducts_ = motor.has_value();
  if (conducts_)
    configure(*motor);
  else
    current_A_ = 0.0;  // the arc dissipates the energy of the inductance
}

void MotorDrive::set_leg_fault(unsigned leg, LegFault fault, Ticks now) {
  advance(now);
  legs_[leg].fault = fault;
}

void MotorDrive::set_leg_delay(unsigned leg, Ticks delay) { legs_[leg].delay = delay; }

Leg MotorDrive::LegState::acting() const {
  switch (fault) {
    case LegFault::high: return Leg::high;
    case LegFault::low: return Leg::low;
    case LegFault::open: return Leg::floating;
    case LegFault::none: break;
  }
  return actual;
}

void MotorDrive::set_leg(unsigned leg, Leg level, Ticks now) {
  advance(now);
  LegState& state = legs_[leg];
  if (state.wanted == level) return;
  state.wanted = level;
  // The conducting switch of a leg turns off immediately. The other switch turns on after the dead time.
  const Ticks pause = dead_time_ + state.delay;
  state.actual = pause == 0 ? level : Leg::floating;
  state.settles_at = now + pause;
}

void MotorDrive::advance(Ticks now) {
  while (now_ < now) {
    Ticks next = now;
    for (const LegState& leg : legs_)
      if (leg.actual != leg.wanted && leg.settles_at < next) next = leg.settles_at;
    if (next > now_) integrate(next - now_);
    now_ = next;
    for (LegState& leg : legs_)
      if (leg.settles_at <= now_) leg.actual = leg.wanted;
  }
}

MotorDrive::Charges MotorDrive::take_charges() {
  const Charges taken = charges_;
  charges_ = {};
  return taken;
}

// The conducting diode of a floating leg clamps the leg to a rail. A positive current flows out of leg A and into leg
// B.
MotorDrive::Branch MotorDrive::branch() const {
  if (!conducts_) return {back_emf_V_, 0.0, false, false};
  const Leg a = legs_[0].acting();
  const Leg b = legs_[1].acting();
  const bool floating = a == Leg::floating || b == Leg::floating;
  const auto with_sign = [&](bool positive) {
    const bool a_top = a == Leg::high || (a == Leg::floating && !positive);
    const bool b_top = b == Leg::high || (b == Leg::floating && positive);
    const double drop = positive ? diode_drop_V_ : -diode_drop_V_;
    const double a_V = (a_top ? bus_V_ : 0.0) - (a == Leg::floating ? drop : 0.0);
    const double b_V = (b_top ? bus_V_ : 0.0) + (b == Leg::floating ? drop : 0.0);
    return Branch{a_V - b_V, static_cast<double>(a_top) - static_cast<double>(b_top), true, floating};
  };
  if (!floating || current_A_ > 0.0) return with_sign(true);
  if (current_A_ < 0.0) return with_sign(false);
  // A current starts from zero only if the bridge voltage, reduced by the diode voltages, exceeds the back EMF in the
  // direction of the current.
  if (const Branch forward = with_sign(true); forward.voltage_V > back_emf_V_) return forward;
  if (const Branch backward = with_sign(false); backward.voltage_V < back_emf_V_) return backward;
  return {back_emf_V_, 0.0, false, false};
}

void MotorDrive::integrate(Ticks duration) {
  double left_s = seconds(duration);
  double decay, amplifier_decay;
  if (duration == dead_time_) {
    decay = dead_time_decay_;
    amplifier_decay = dead_time_amplifier_decay_;
  } else {
    decay = std::exp(-left_s / time_constant_s_);
    amplifier_decay = std::exp(-left_s / amplifier_time_constant_s_);
  }
  const Branch first = branch();
  const double final_A = (first.voltage_V - back_emf_V_) * inverse_resistance_;
  const double end_A = final_A + (current_A_ - final_A) * decay;
  if (!first.holds_at_zero || current_A_ == 0.0 || end_A * current_A_ > 0.0) {
    run(left_s, decay, amplifier_decay, first);
    return;
  }
  const double to_zero_s = time_constant_s_ * std::log((current_A_ - final_A) / -final_A);
  run(to_zero_s, std::exp(-to_zero_s / time_constant_s_), std::exp(-to_zero_s / amplifier_time_constant_s_), first);
  current_A_ = 0.0;
  left_s -= to_zero_s;
  if (left_s > 0.0)
    run(left_s, std::exp(-left_s / time_constant_s_), std::exp(-left_s / amplifier_time_constant_s_), branch());
}

void MotorDrive::run(double duration_s, double decay, double amplifier_decay, const Branch& path) {
  const double final_A = path.conducts ? (path.voltage_V - back_emf_V_) * inverse_resistance_ : 0.0;
  const double transient_A = current_A_ - final_A;
  const double charge_As = final_A * duration_s + transient_A * time_constant_s_ * (1.0 - decay);
  charges_.motor_As += charge_As;
  charges_.supply_As += path.supply_share * charge_As;
  // The amplifier is a first-order low-pass filter. The amplifier output is the sum of a forced response and a decaying
  // free response.
  const double forced_A = amplifier_lead_ * transient_A;
  amplifier_A_ = final_A + forced_A * decay + (amplifier_A_ - final_A - forced_A) * amplifier_decay;
  current_A_ = final_A + transient_A * decay;
}

}  // namespace inkwell::virtual_board
