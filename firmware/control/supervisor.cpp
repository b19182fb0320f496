#include <control/supervisor.hpp>

namespace inkwell::control {

namespace {

using protocol::Fault;
using protocol::State;

/// The fault to show for these conditions in this state, the one that explains the others first.
Fault find_fault(State state, const Conditions& conditions, Fault raised) {
  const bool started = state != State::starting;
  const bool moving = state == State::ready || state == State::active;
  const bool active = state == State::active;
  if (raised != Fault::none) return raised;
  if (conditions.not_finite) return Fault::not_finite;
  if (conditions.offsets_measured && !conditions.offsets_plausible) return Fault::current_sensor;
  if (started && conditions.samples_stale) return Fault::samples_stale;
  if (started && conditions.supply_low) return Fault::supply_low;
  if (started && conditions.supply_high) return Fault::supply_high;
  if (started && conditions.bridge_fault) return Fault::bridge_fault;
  if (started && conditions.over_current) return Fault::over_current;
  if (started && conditions.motor_hot) return Fault::motor_hot;
  if (moving && conditions.encoder_implausible) return Fault::encoder_implausible;
  if (active && conditions.over_speed) return Fault::over_speed;
  if (active && conditions.host_silent) return Fault::host_silent;
  return Fault::none;
}

bool cause_is_gone(Fault fault, const Conditions& conditions) {
  switch (fault) {
    case Fault::not_finite: return !conditions.not_finite;
    case Fault::current_sensor: return conditions.offsets_plausible;
    case Fault::supply_low: return !conditions.supply_low;
    case Fault::supply_high: return !conditions.supply_high;
    case Fault::bridge_fault: return !conditions.bridge_fault;
    case Fault::samples_stale: return !conditions.samples_stale;
    case Fault::over_current: return !conditions.over_current;
    case Fault::motor_hot: return !conditions.motor_hot;
    default: return true;
  }
}

/// Where the device stands by what it has measured so far, with the force off.
State resting_state(const Conditions& conditions) {
  if (!conditions.offsets_measured) return State::starting;
  return conditions.referenced ? State::ready : State::unreferenced;
}

}  // namespace

Supervisor advance(const Supervisor& supervisor, const Conditions& conditions, const Requests& requests) {
  if (supervisor.state == State::fault) {
    const bool cleared = requests.clear_fault && cause_is_gone(supervisor.fault, conditions);
    return cleared ? Supervisor{resting_state(conditions), Fault::none} : supervisor;
  }
  const Fault fault = find_fault(supervisor.state, conditions, requests.raised);
  if (fault != Fault::none) return {State::fault, fault};
  if (supervisor.state == State::active) return {requests.disable_force ? State::ready : State::active, Fault::none};
  if (supervisor.state == State::ready && requests.enable_force && !requests.disable_force)
    return {State::active, Fault::none};
  return {resting_state(conditions), Fault::none};
}

}  // namespace inkwell::control
