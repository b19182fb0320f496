#include "reasons.hpp"

#include <string>

#include <chip/exception_numbers.hpp>

namespace inkwell::campaign {

using protocol::InjectedFault;

namespace {

/// Reason why a fault of a wire may stay undetected, by the function of the wire.
std::string_view reason_of_wire(std::string_view wire) {
  if (wire.starts_with("encoders"))
    return "A dead wire is detected by a count that alternates, or by a motor that turns, or repeatedly changes its "
           "force, while the joint seems stationary.";
  if (wire.starts_with("bridges"))
    return "While no motor current is requested, no missing current is detected. The levels of the legs are checked "
           "only while the bridges are off.";
  if (wire.starts_with("bridge_fault"))
    return "The level is that of healthy bridges. The self-test at the next start detects a broken wire, but not a "
           "wire shorted to the supply.";
  if (wire == "bridge_enable")
    return "The level is that of the force switched on, and so is the level of the chip's pin.";
  if (wire == "bridge_heartbeat") return "None is known: without the heartbeat the bridges are off.";
  if (wire == "bridge_hold") return "The level is that of the bridges switched on.";
  if (wire.starts_with("motor_current"))
    return "The reading stays near the reference, or its effect stays within the tolerance of a healthy motor.";
  if (wire.starts_with("gimbal"))
    return "Only a custom force law can use the stylus angles, and a healthy potentiometer has the same reading at an "
           "end of its track. The age of the measurement is monitored. The next self-test detects a reading at an end "
           "of the track.";
  if (wire == "supply") return "The reading is that of a healthy supply.";
  if (wire == "usb_supply") return "The level is that of a plugged-in cable.";
  return "An open or closed wire looks like a released or pressed switch. The inkwell switch is reported if it is "
         "closed outside the inkwell.";
}

const std::string of_stalled_main_loop = std::to_string(virtual_board::exception_pendsv);
const std::string of_voltage_detector =
    std::to_string(virtual_board::exception_of(virtual_board::voltage_detector_position));

/// For faults that only accompany another fault, lateness is not judged.
std::string_view reason_of_exception(std::string_view exception, std::string_view of_control_interrupt) {
  if (exception == of_stalled_main_loop)
    return "This exception is requested only if the main loop hangs, to record its location. That would be a second "
           "fault.";
  if (exception == of_voltage_detector)
    return "This exception occurs only if the chip's supply falls, which would be a second fault. The main loop also "
           "checks the supply, and the brown-out reset follows.";
  return of_control_interrupt;
}

constexpr std::string_view host_is_missed = "None is known: a silent host is detected.";
constexpr std::string_view no_force_to_lose = "A lost USB connection is reported only while the force is on.";
constexpr std::string_view falls_anyway =
    "The force was switched off already and was decreasing. It stops immediately, which only the state reports.";
constexpr std::string_view chip_is_frozen = "The chip is in reset while its supply is too low, and reports nothing.";
constexpr std::string_view not_begun = "A core that does not take its first instruction has not begun.";
constexpr std::string_view stalled_unwatched =
    "The main loop is not monitored before it runs, while another fault is reported, and during the transition to the "
    "boot loader. The main loop continued before the watchdog expired.";
constexpr std::string_view pulses_were_over =
    "The fault occurred when this motor's pulses were over or almost over. The next self-test detects the fault.";
constexpr std::string_view break_of_tim8 =
    "Only the break input of TIM8 reads this pin, while the bridges are on. The self-test's pulses switch the bridges "
    "on.";

/// Whether the self-test's pulses detect the fault. A fault that the pulses detect can stay undetected only if it
/// occurs after the pulses.
bool is_tested_by_pulses(const CaseFault& put_in) {
  switch (*put_in.fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen:
    case InjectedFault::wires_shorted:
      return put_in.of.starts_with("bridges") || put_in.of.starts_with("motor_current");
    case InjectedFault::shunt_gain:
    case InjectedFault::shunt_frozen:
    case InjectedFault::motor_open:
    case InjectedFault::motor_shorted:
    case InjectedFault::leg_open:
    case InjectedFault::leg_slow: return true;
    default: return false;
  }
}

/// Reason for a wire while the bridges are off.
std::string_view reason_of_idle_wire(InjectedFault fault, std::string_view wire) {
  if (wire.starts_with("encoders"))
    return "The hand holds the joint still. Once there is a reference, a dead wire is detected by a count that "
           "alternates when the joint turns.";
  if (wire.starts_with("bridges"))
    return "The leg is low, as it has to be while the bridges are off. The next self-test detects the fault, or the "
           "motor check once a current is requested.";
  if (wire == "bridge_fault_tim8" && fault == InjectedFault::wire_low) return break_of_tim8;
  if (wire == "bridge_enable")
    return "The level of the chip's pin is correct. If the bridges receive a low level, the first heartbeat detects "
           "the fault. If they receive a high level, the end of the heartbeat still switches them off.";
  if (wire == "bridge_heartbeat")
    return "The level is low, as it has to be while the bridges are off. The first heartbeat detects the fault.";
  if (wire == "bridge_hold")
    return "The level is low, as it has to be while the bridges are off. The first heartbeat detects the fault.";
  if (wire.starts_with("motor_current"))
    return "No current flows, and the reading is zero. The next self-test detects the fault, or the motor check once a "
           "current is requested.";
  if (wire == "usb_supply" && (fault == InjectedFault::wire_open || fault == InjectedFault::wire_low))
    return no_force_to_lose;
  if (wire == "inkwell_switch" && fault == InjectedFault::wire_low)
    return "Before there is a reference it looks like a stylus in the inkwell, and nothing else knows where that is: "
           "the board takes the arm to be there. During a self-test, or while another fault is told, the reference is "
           "given up without a fault.";
  return reason_of_wire(wire);
}

}  // namespace

std::string_view reason_with_force(const CaseFault& put_in) {
  if (put_in.deed == Deed::fast_hand) return "None is known: the speed is monitored in each period.";
  if (put_in.deed == Deed::bus_suspended) return host_is_missed;
  const std::string_view of = put_in.of;
  switch (*put_in.fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen: return reason_of_wire(of);
    case InjectedFault::wires_shorted: return "The two levels were equal, or are not compared.";
    case InjectedFault::wire_spikes: return "The input filters and the next reading of the inputs tolerate the spikes.";
    case InjectedFault::encoder_stuck:
      return "The fault is detected by a motor that turns, or repeatedly changes its force, while the joint seems "
             "stationary.";
    case InjectedFault::encoder_lost_counts:
    case InjectedFault::encoder_slip:
      return "No second sensor knows the joint, and a motor's voltage may differ by more; what is noticed is an angle "
             "far beyond its stop, a jump of 16 counts, and a place that is not the inkwell while its switch is "
             "closed.";
    case InjectedFault::shunt_gain:
      return "Voltage, reading and speed are within the tolerance of a healthy motor. The next self-test detects the "
             "fault.";
    case InjectedFault::shunt_offset:
    case InjectedFault::shunt_frozen: return "Voltage, reading and speed are within the tolerance of a healthy motor.";
    case InjectedFault::shunt_high:
    case InjectedFault::shunt_low: return "None is known: a reading at its rail is more than any sensor can show.";
    case InjectedFault::motor_open:
    case InjectedFault::leg_open: return "While no motor current is requested, no missing current is detected.";
    case InjectedFault::motor_shorted:
      return "With a small current the voltage stays within the tolerance of a healthy motor. The next self-test "
             "detects the fault.";
    case InjectedFault::motor_hot:
      return "The current loop makes up for it, and its voltage stays within what a sound motor may differ by, or its "
             "bound keeps it there; nothing measures the torque.";
    case InjectedFault::leg_high:
    case InjectedFault::leg_low: return "The leg's other switch, at which the bridge trips, was not turned on.";
    case InjectedFault::leg_slow:
      return "The current loop compensates the fault, and the voltage loss of the leg is within the tolerance of a "
             "healthy leg.";
    case InjectedFault::bridge_fault: return "None is known: the timers' break inputs see the wire.";
    case InjectedFault::supply_sag:
    case InjectedFault::supply_spike:
    case InjectedFault::supply_cut: return "The capacitors maintain the supply for this time.";
    case InjectedFault::supply_ripple:
      return "It swings by less than a volt, which sound motors may bring about, or has not swung often enough.";
    case InjectedFault::logic_sag: return "The voltage is above 2.9 V.";
    case InjectedFault::analog_sag:
      return "The error is within the tolerance of a healthy regulator and of the reference.";
    case InjectedFault::crystal_stop: return "None is known: the clock's own guard sees it.";
    case InjectedFault::crystal_drift:
      return "The drift is within the tolerance of the clock and of USB. No second clock is compared.";
    case InjectedFault::usb_cut: return host_is_missed;
    case InjectedFault::host_silent: return "A force that falls by itself needs no host.";
    case InjectedFault::core_stalled:
      return "None is known: the heartbeat stops with the core, and the watchdog is not fed.";
    case InjectedFault::core_halted: return "None is known: the heartbeat and the timers stop with the core.";
    case InjectedFault::main_loop_stalled: return "None is known: the control interrupt misses it.";
    case InjectedFault::program_astray:
      return "The code that it came to returned to the main loop, and had changed nothing that is checked.";
    case InjectedFault::exception_lost:
      return reason_of_exception(of, "None is known: the heartbeat and the watchdog miss the control interrupt.");
    case InjectedFault::exception_late:
      return reason_of_exception(of, "The exception is late by less than the monitored limit.");
    case InjectedFault::adc_stopped: return "None is known: each current conversion has to be a new conversion.";
    case InjectedFault::dma_stopped: return "None is known: the age of the supply and gimbal readings is monitored.";
    case InjectedFault::ram_bit:
      return "Of the RAM only the interrupts' code and tables and the settings are checked; the byte was not used, or "
             "written anew before.";
    case InjectedFault::flash_bit:
      return "The bit lay outside the image: in the sectors of the stored parameters, or where nothing lies.";
  }
  return "";
}

std::string_view reason_without_force(const CaseFault& put_in, CaseSituation situation) {
  if (put_in.deed == Deed::fast_hand) return "The speed of the hand is not limited while the force is off.";
  if (put_in.deed == Deed::bus_suspended) return no_force_to_lose;
  const InjectedFault fault = *put_in.fault;
  const std::string_view of = put_in.of;
  const bool is_starting = situation == CaseSituation::starting;
  if (is_tested_by_pulses(put_in) && (is_starting || situation == CaseSituation::testing)) return pulses_were_over;
  switch (fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen: return reason_of_idle_wire(fault, of);
    case InjectedFault::wire_spikes:
      if (of == "bridge_fault_tim8") return break_of_tim8;
      return reason_with_force(put_in);
    case InjectedFault::wires_shorted:
      return "The two levels are equal while the bridges are off and the hand holds the joint still.";
    case InjectedFault::encoder_stuck: return "The hand holds the joint still, and no motor turns it.";
    case InjectedFault::encoder_lost_counts:
      return "The hand holds the joint still, so that no count comes that could be lost.";
    case InjectedFault::encoder_slip:
      return "Before there is a reference it does not matter; during a self-test, or while another fault is told, the "
             "reference is given up without a fault. Either way the inkwell gives a new one.";
    case InjectedFault::shunt_gain:
    case InjectedFault::shunt_frozen:
      return "No current flows, and the reading is zero. The next self-test detects the fault, or the motor check once "
             "a current is requested.";
    case InjectedFault::motor_hot:
      return "A motor that is 100 K hotter passes the self-test, and nothing else drives it without force.";
    case InjectedFault::motor_open:
    case InjectedFault::motor_shorted:
    case InjectedFault::leg_open:
    case InjectedFault::leg_slow:
      return "The bridges are off and no current flows. The next self-test detects the fault.";
    case InjectedFault::leg_high:
    case InjectedFault::leg_low:
      return "The bridge trips when the leg's other switch joins it: in the next self-test, or once the force is on.";
    case InjectedFault::supply_spike:
      if (situation != CaseSituation::fault && situation != CaseSituation::update) return reason_with_force(put_in);
      return "While another fault is told, and in the boot loader, nobody looks at the supply, and it is sound again "
             "afterwards.";
    case InjectedFault::logic_sag:
      if (!is_starting && situation != CaseSituation::update) return reason_with_force(put_in);
      return chip_is_frozen;
    case InjectedFault::crystal_drift:
    case InjectedFault::usb_cut: return no_force_to_lose;
    case InjectedFault::host_silent: return "A silent host is detected only while the force is on.";
    case InjectedFault::core_stalled: return is_starting ? not_begun : reason_with_force(put_in);
    case InjectedFault::main_loop_stalled:
      if (put_in.amount) return stalled_unwatched;
      return is_starting ? not_begun : reason_with_force(put_in);
    case InjectedFault::program_astray:
      if (!is_starting) return reason_with_force(put_in);
      return "The code that it came to returned to the main loop, and had changed nothing that is checked; or it came "
             "before the watchdog runs, and hung until the reset with the bridges off.";
    case InjectedFault::core_halted:
      return "A core that stands tells nothing; it goes on as if nothing had been, because the bridges were off and "
             "nothing moved meanwhile.";
    default: return reason_with_force(put_in);
  }
}

std::string_view reason_of_silence(const CaseFault& put_in, CaseSituation situation) {
  constexpr std::string_view unknown = "None is known: every cause that switches the bridges off is reported.";
  if (put_in.deed == Deed::fast_hand) return unknown;
  const std::string_view usb_gone = situation == CaseSituation::landing ? falls_anyway : unknown;
  if (put_in.deed == Deed::bus_suspended) return usb_gone;
  const std::string_view of = put_in.of;
  switch (*put_in.fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen:
      if (of == "usb_supply") return usb_gone;
      break;
    case InjectedFault::logic_sag: return chip_is_frozen;
    case InjectedFault::crystal_drift:
    case InjectedFault::usb_cut: return usb_gone;
    case InjectedFault::host_silent:
      return "No host requests a report. The fault is reported when the host is active again.";
    case InjectedFault::core_halted:
      return "A halted core reports nothing. When it continues, it reports that the bridges were released.";
    default: break;
  }
  return unknown;
}

}  // namespace inkwell::campaign
