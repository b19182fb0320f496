#include "host/lab/campaign/reasons.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "boards/stm32f405/core/exception_numbers.hpp"

#include "host/lab/campaign/wires.hpp"

namespace inkwell::campaign {

using protocol::InjectedFault;

namespace {

/// Returns the reason why a wire fault may stay undetected.
std::string_view reason_of_wire(Wire wire) {
  switch (wire) {
    case Wire::encoder:
      return "A constant encoder signal is detected only when the joint or the force changes: the count then "
             "alternates, or the motor check reports missing motion.";
    case Wire::bridge_leg:
      return "The motor check needs a requested current. The leg levels are checked only while the bridges are off.";
    case Wire::bridge_fault_tim1:
    case Wire::bridge_fault_tim8:
      return "The wire has the level of healthy bridges. The next self-test detects a broken wire, but not a short to "
             "the supply.";
    case Wire::bridge_enable: return "Wire and microcontroller pin have the same level as with the force on.";
    case Wire::bridge_heartbeat: return "No reason is known: without the heartbeat the bridges are off.";
    case Wire::bridge_hold: return "The wire has the same level as with the bridges on.";
    case Wire::motor_current:
      return "The reading stays near the requested current, or the resulting motor voltage stays within the tolerance "
             "of a healthy motor.";
    case Wire::gimbal:
      return "Only the user's force law can use the stylus angles. At the end of its track, a healthy potentiometer "
             "reads the same value. Only the age of the readings is monitored. The next self-test detects a reading at "
             "the end of the track.";
    case Wire::supply: return "The wire shows a valid supply voltage.";
    case Wire::usb_supply: return "The wire has the same level as with the cable connected.";
    case Wire::button:
    case Wire::inkwell_switch:
    case Wire::other: break;
  }
  return "A faulty switch wire looks like a released or pressed switch. The inkwell switch is checked only for a "
         "closed contact outside the inkwell.";
}

const std::string of_stalled_main_loop = std::to_string(virtual_board::exception_pendsv);
const std::string of_voltage_detector =
    std::to_string(virtual_board::exception_of(virtual_board::voltage_detector_position));

/// An interrupt that occurs only together with another fault needs no separate detection.
std::string_view reason_of_exception(std::string_view exception, std::string_view of_control_interrupt) {
  if (exception == of_stalled_main_loop)
    return "This interrupt is requested only to record where the main loop hangs, which would be a second fault.";
  if (exception == of_voltage_detector)
    return "This interrupt occurs only when the microcontroller supply falls, which would be a second fault. The main "
           "loop and the brown-out reset also monitor this supply.";
  return of_control_interrupt;
}

constexpr std::string_view host_is_missed = "No reason is known: a silent host is detected.";
constexpr std::string_view no_force_to_lose = "A lost USB connection is reported only while the force is on.";
constexpr std::string_view falls_anyway =
    "The force was already decreasing after it was switched off. It becomes zero immediately, and only the state shows "
    "this.";
constexpr std::string_view chip_is_frozen =
    "The microcontroller does not run while its supply is too low, so it cannot report a fault.";
constexpr std::string_view not_begun = "The core was stopped before its first instruction, so no firmware was running.";
constexpr std::string_view stalled_unwatched =
    "The main loop is not monitored during start-up, during another fault, or during the transition to the boot "
    "loader. It continued before the watchdog expired.";
constexpr std::string_view pulses_were_over =
    "The fault occurred after the self-test pulses of this motor, or near their end. The next self-test detects it.";
constexpr std::string_view break_of_tim8 =
    "Only the break input of TIM8 reads this pin, and only while the bridges are on. The self-test pulses switch the "
    "bridges on.";

constexpr std::string_view no_second_sensor =
    "No second sensor measures the joint, and the voltage tolerance of a motor is larger than the effect. The "
    "board detects an angle far beyond its stop, a jump of 16 counts, and a closed inkwell switch outside the "
    "inkwell.";
constexpr std::string_view within_motor_tolerance =
    "Voltage, reading and speed agree within the tolerance of a healthy motor.";
constexpr std::string_view sensor_at_rail =
    "No reason is known: a healthy sensor cannot produce a reading at its rail.";
constexpr std::string_view no_current_requested =
    "No current is requested from this motor, so the motor check cannot find a missing current.";
constexpr std::string_view other_switch_off =
    "The other switch of the leg, which would trip the bridge, was not turned on.";
constexpr std::string_view capacitors_buffer = "The capacitors buffer the supply for this time.";
constexpr std::string_view no_current_flows =
    "No current flows, and the sensor reads zero. The next self-test detects the fault, or the motor check "
    "once a current is requested.";
constexpr std::string_view bridges_are_off =
    "The bridges are off and no current flows. The next self-test detects the fault.";
constexpr std::string_view bridge_trips_later =
    "The bridge trips when the other switch of the leg turns on. This occurs in the next self-test, or when "
    "the force is switched on.";

struct Reason {
  InjectedFault fault;
  std::string_view text;
};

template <std::size_t count>
constexpr std::optional<std::string_view> reason_in(const std::array<Reason, count>& table, InjectedFault fault) {
  for (const Reason& row : table)
    if (row.fault == fault) return row.text;
  return std::nullopt;
}

/// Reasons for faults with the force on.
constexpr auto reasons_with_force = std::to_array<Reason>({
    {InjectedFault::wires_shorted, "The two wires had the same level, or no check compares them."},
    {InjectedFault::wire_spikes, "The input filters and repeated reads tolerate the spikes."},
    {InjectedFault::encoder_stuck,
     "A stuck encoder is detected only when the motor turns or its force changes repeatedly while the count "
     "does not change."},
    {InjectedFault::encoder_lost_counts, no_second_sensor},
    {InjectedFault::encoder_slip, no_second_sensor},
    {InjectedFault::shunt_gain,
     "Voltage, reading and speed agree within the tolerance of a healthy motor. The next self-test detects the "
     "fault."},
    {InjectedFault::shunt_offset, within_motor_tolerance},
    {InjectedFault::shunt_frozen, within_motor_tolerance},
    {InjectedFault::shunt_high, sensor_at_rail},
    {InjectedFault::shunt_low, sensor_at_rail},
    {InjectedFault::motor_open, no_current_requested},
    {InjectedFault::leg_open, no_current_requested},
    {InjectedFault::motor_shorted,
     "With a small current, the motor voltage stays within the tolerance of a healthy motor. The next "
     "self-test detects the fault."},
    {InjectedFault::motor_hot,
     "The current loop compensates for the higher resistance. The motor voltage stays within the tolerance of "
     "a healthy motor, or at its limit. No sensor measures the torque."},
    {InjectedFault::leg_high, other_switch_off},
    {InjectedFault::leg_low, other_switch_off},
    {InjectedFault::leg_slow,
     "The current loop compensates for the delay, and the voltage loss of the leg is within the tolerance of a "
     "healthy leg."},
    {InjectedFault::bridge_fault, "No reason is known: the break inputs of the timers monitor the wire."},
    {InjectedFault::supply_sag, capacitors_buffer},
    {InjectedFault::supply_spike, capacitors_buffer},
    {InjectedFault::supply_cut, capacitors_buffer},
    {InjectedFault::supply_ripple,
     "The ripple is below 1 V, which healthy motors can cause, or it has lasted too few periods."},
    {InjectedFault::logic_sag, "The voltage is above 2.9 V."},
    {InjectedFault::analog_sag,
     "The deviation is within the tolerance of a healthy regulator and of the reference voltage."},
    {InjectedFault::crystal_stop, "No reason is known: the clock security system detects a stopped crystal."},
    {InjectedFault::crystal_drift,
     "The deviation is within the tolerance of the clock and of USB, and no second clock is compared."},
    {InjectedFault::usb_cut, host_is_missed},
    {InjectedFault::host_silent, "A force that is already decreasing does not need a host."},
    {InjectedFault::core_stalled, "No reason is known: the heartbeat stops with the core, and the watchdog expires."},
    {InjectedFault::core_halted, "No reason is known: the heartbeat and the timers stop with the core."},
    {InjectedFault::main_loop_stalled, "No reason is known: the control interrupt monitors the main loop."},
    {InjectedFault::program_astray,
     "The code at the target address returned to the main loop and changed nothing that is checked."},
    {InjectedFault::adc_stopped, "No reason is known: the firmware checks that each current conversion is new."},
    {InjectedFault::dma_stopped, "No reason is known: the age of the supply and gimbal readings is monitored."},
    {InjectedFault::ram_bit,
     "In the RAM, only the interrupt code, its tables and the settings are checked. The changed byte was not "
     "used, or was overwritten before its use."},
    {InjectedFault::flash_bit,
     "The bit was outside the image, either in the sectors of the stored parameters or in unused flash."},
});

constexpr bool depends_on_location(InjectedFault fault) {
  using enum InjectedFault;
  return fault == wire_open || fault == wire_low || fault == wire_high || fault == wire_frozen ||
         fault == exception_lost || fault == exception_late;
}
constexpr bool every_fault_has_a_reason() {
  for (std::size_t i = 0; i < protocol::injection_table.size(); ++i) {
    const auto fault = static_cast<InjectedFault>(i);
    if (reason_in(reasons_with_force, fault).has_value() == depends_on_location(fault)) return false;
  }
  return true;
}
static_assert(every_fault_has_a_reason(), "reasons_with_force: each fault whose location does not matter needs a row");

/// These reasons replace `reasons_with_force` while the force is off.
constexpr auto reasons_without_force = std::to_array<Reason>({
    {InjectedFault::wires_shorted,
     "The two wires have the same level while the bridges are off and the hand keeps the joint stationary."},
    {InjectedFault::encoder_stuck, "The hand keeps the joint stationary, and no motor turns it."},
    {InjectedFault::encoder_lost_counts, "The hand keeps the joint stationary, so no counts occur that could be lost."},
    {InjectedFault::encoder_slip,
     "Without a reference, the slip has no effect. During a self-test or another fault, the reference is "
     "cleared without a fault. The inkwell then provides a new reference."},
    {InjectedFault::shunt_gain, no_current_flows},
    {InjectedFault::shunt_frozen, no_current_flows},
    {InjectedFault::motor_hot,
     "A motor that is 100 K hotter passes the self-test, and no other function drives it without force."},
    {InjectedFault::motor_open, bridges_are_off},
    {InjectedFault::motor_shorted, bridges_are_off},
    {InjectedFault::leg_open, bridges_are_off},
    {InjectedFault::leg_slow, bridges_are_off},
    {InjectedFault::leg_high, bridge_trips_later},
    {InjectedFault::leg_low, bridge_trips_later},
    {InjectedFault::crystal_drift, no_force_to_lose},
    {InjectedFault::usb_cut, no_force_to_lose},
    {InjectedFault::host_silent, "A silent host is detected only while the force is on."},
    {InjectedFault::core_halted,
     "A halted core cannot report a fault. Afterwards it continued normally, because the bridges were off and "
     "nothing had moved."},
});

/// Returns true if the self-test pulses detect the fault. A fault after the pulses can stay undetected.
bool is_tested_by_pulses(const CaseFault& put_in) {
  switch (*put_in.fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen:
    case InjectedFault::wires_shorted:
      return wire_of(put_in.of) == Wire::bridge_leg || wire_of(put_in.of) == Wire::motor_current;
    case InjectedFault::shunt_gain:
    case InjectedFault::shunt_frozen:
    case InjectedFault::motor_open:
    case InjectedFault::motor_shorted:
    case InjectedFault::leg_open:
    case InjectedFault::leg_slow: return true;
    default: return false;
  }
}

/// Returns the reason why a wire fault may stay undetected while the bridges are off.
std::string_view reason_of_idle_wire(InjectedFault fault, Wire wire) {
  switch (wire) {
    case Wire::encoder:
      return "The hand keeps the joint stationary. With a reference, a constant encoder signal is detected by "
             "alternating counts when the joint turns.";
    case Wire::bridge_leg:
      return "The leg is low, which is correct while the bridges are off. The next self-test detects the fault, or the "
             "motor check once a current is requested.";
    case Wire::bridge_fault_tim8:
      if (fault == InjectedFault::wire_low) return break_of_tim8;
      break;
    case Wire::bridge_enable:
      return "The microcontroller pin has the correct level. A low level at the bridges is detected at the first "
             "heartbeat. With a high level, the bridges still switch off when the heartbeat stops.";
    case Wire::bridge_heartbeat:
    case Wire::bridge_hold:
      return "The wire is low, which is correct while the bridges are off. The fault is detected at the first "
             "heartbeat.";
    case Wire::motor_current:
      return "No current flows, and the sensor reads zero. The next self-test detects the fault, or the motor check "
             "once a current is requested.";
    case Wire::usb_supply:
      if (fault == InjectedFault::wire_open || fault == InjectedFault::wire_low) return no_force_to_lose;
      break;
    case Wire::inkwell_switch:
      if (fault == InjectedFault::wire_low)
        return "Without a reference, the wire looks like a stylus in the inkwell, so the board references the arm at a "
               "wrong position. During a self-test or another fault, the reference is cleared without a fault.";
      break;
    case Wire::bridge_fault_tim1:
    case Wire::gimbal:
    case Wire::supply:
    case Wire::button:
    case Wire::other: break;
  }
  return reason_of_wire(wire);
}

std::string_view reason_of_models(Deed deed) {
  switch (deed) {
    case Deed::models_lost: return "A model fades 20 ms after its last report. The end of a program is not a fault.";
    case Deed::models_stale:
    case Deed::models_malformed: return "The board refuses the models and counts them, and the last model fades.";
    case Deed::models_contradictory: return "Each model is valid, and a new model does not raise the force.";
    default: return "";
  }
}

}  // namespace

std::string_view reason_with_force(const CaseFault& put_in) {
  if (put_in.deed == Deed::fast_hand) return "No reason is known: the speed is checked in each control period.";
  if (put_in.deed == Deed::bus_suspended) return host_is_missed;
  if (is_about_models(put_in.deed)) return reason_of_models(put_in.deed);
  switch (*put_in.fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen: return reason_of_wire(wire_of(put_in.of));
    case InjectedFault::exception_lost:
      return reason_of_exception(put_in.of,
                                 "No reason is known: the heartbeat and the watchdog depend on the control interrupt.");
    case InjectedFault::exception_late:
      return reason_of_exception(put_in.of, "The delay is shorter than the delay that the firmware detects.");
    default: return reason_in(reasons_with_force, *put_in.fault).value_or("");
  }
}

std::string_view reason_without_force(const CaseFault& put_in, CaseSituation situation) {
  if (put_in.deed == Deed::fast_hand) return "Without a force, the hand speed is not limited.";
  if (put_in.deed == Deed::bus_suspended) return no_force_to_lose;
  if (is_about_models(put_in.deed)) return "Without a force, a local model moves nothing.";
  const InjectedFault fault = *put_in.fault;
  const bool is_starting = situation == CaseSituation::starting;
  if (is_tested_by_pulses(put_in) && (is_starting || situation == CaseSituation::testing)) return pulses_were_over;
  if (const auto reason = reason_in(reasons_without_force, fault)) return *reason;
  switch (fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen: return reason_of_idle_wire(fault, wire_of(put_in.of));
    case InjectedFault::wire_spikes:
      if (wire_of(put_in.of) == Wire::bridge_fault_tim8) return break_of_tim8;
      return reason_with_force(put_in);
    case InjectedFault::supply_spike:
      if (situation != CaseSituation::fault && situation != CaseSituation::update) return reason_with_force(put_in);
      return "The supply is not monitored during another fault or in the boot loader, and it is valid again "
             "afterwards.";
    case InjectedFault::logic_sag:
      if (!is_starting && situation != CaseSituation::update) return reason_with_force(put_in);
      return chip_is_frozen;
    case InjectedFault::core_stalled: return is_starting ? not_begun : reason_with_force(put_in);
    case InjectedFault::main_loop_stalled:
      if (put_in.amount) return stalled_unwatched;
      return is_starting ? not_begun : reason_with_force(put_in);
    case InjectedFault::program_astray:
      if (!is_starting) return reason_with_force(put_in);
      return "The code at the target address returned to the main loop and changed nothing that is checked. If the "
             "fault occurred before the watchdog started, the firmware hung with the bridges off until the reset.";
    default: return reason_with_force(put_in);
  }
}

std::string_view reason_of_silence(const CaseFault& put_in, CaseSituation situation) {
  constexpr std::string_view unknown = "No reason is known: each cause that switches the bridges off is reported.";
  if (put_in.deed == Deed::fast_hand || is_about_models(put_in.deed)) return unknown;
  const std::string_view usb_gone = situation == CaseSituation::landing ? falls_anyway : unknown;
  if (put_in.deed == Deed::bus_suspended) return usb_gone;
  switch (*put_in.fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen:
      if (wire_of(put_in.of) == Wire::usb_supply) return usb_gone;
      break;
    case InjectedFault::logic_sag: return chip_is_frozen;
    case InjectedFault::crystal_drift:
    case InjectedFault::usb_cut: return usb_gone;
    case InjectedFault::host_silent: return "No host polls the board. The fault is reported when the host polls again.";
    case InjectedFault::core_halted:
      return "A halted core cannot report a fault. When the core continues, it reports the missing heartbeat.";
    default: break;
  }
  return unknown;
}

}  // namespace inkwell::campaign
