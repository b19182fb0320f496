#include "reasons.hpp"

#include <string>

#include <chip/exception_numbers.hpp>

namespace inkwell::campaign {

using protocol::InjectedFault;

namespace {

/// Reason why a fault of a wire may stay undetected, by the function of the wire.
std::string_view reason_of_wire(std::string_view wire) {
  if (wire.starts_with("encoders"))
    return "A dead wire shows by a count that goes to and fro, or by a motor that turns, or presses otherwise again "
           "and again, while the joint does not seem to move.";
  if (wire.starts_with("bridges"))
    return "While no current is asked of the motor, none is missed, and the legs' levels are looked at while the "
           "bridges are off only.";
  if (wire.starts_with("bridge_fault"))
    return "It stands as with sound bridges. The self-test at the next start tells one that is broken, not one that "
           "touches the supply.";
  if (wire == "bridge_enable") return "It stands as with the force on, and so does the chip's own pin.";
  if (wire == "bridge_heartbeat") return "None is known: without it the bridges are off.";
  if (wire == "bridge_hold") return "It stands as with the bridges on.";
  if (wire.starts_with("motor_current"))
    return "The reading stays near what is asked for, or what it leads to within what a sound motor may differ by.";
  if (wire.starts_with("gimbal"))
    return "Only a force law of one's own can go by the stylus's angles, and at an end of its track a sound "
           "potentiometer reads the same. That they are measured is watched; the next self-test tells of an end.";
  if (wire == "supply") return "It reads a sound supply.";
  if (wire == "usb_supply") return "It stands as with the cable in.";
  return "A switch that is open or closed looks like one that is let go of or pressed; the inkwell's is told where it "
         "is closed elsewhere.";
}

const std::string of_hung_main_loop = std::to_string(virtual_board::exception_pendsv);
const std::string of_voltage_detector =
    std::to_string(virtual_board::exception_of(virtual_board::voltage_detector_position));

/// For faults that only accompany another fault, lateness is not judged.
std::string_view reason_of_exception(std::string_view exception, std::string_view of_control_interrupt) {
  if (exception == of_hung_main_loop)
    return "It is asked for as the main loop hangs only, to note its place; that would be a second fault.";
  if (exception == of_voltage_detector)
    return "It comes when the chip's supply falls only, which would be a second fault; the main loop looks as "
           "well, and the brown-out reset stands behind it.";
  return of_control_interrupt;
}

constexpr std::string_view host_is_missed = "None is known: a host that is not heard is missed.";
constexpr std::string_view no_force_to_lose = "That USB is gone is told while the force is on only.";
constexpr std::string_view falls_anyway =
    "The force was switched off already and was falling; it ends at once, which is told by nothing but the state.";
constexpr std::string_view chip_stands = "The chip stands as long as its supply is too low, and tells nothing.";
constexpr std::string_view not_begun = "A core that does not take its first instruction has not begun.";
constexpr std::string_view stalled_unwatched =
    "Before the main loop runs, while another fault is told and on the way to the boot loader nobody looks, and it "
    "went on before the watchdog bit.";
constexpr std::string_view pulses_were_over =
    "It came when this motor's pulses were over, or nearly so; the next self-test tells.";
constexpr std::string_view break_of_tim8 =
    "This pin is seen by the break input of TIM8 only, while the bridges are on; the self-test's pulses put them on.";

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
    return "The hand holds the joint still; a dead wire shows by a count that goes to and fro when it turns, once "
           "there is a reference.";
  if (wire.starts_with("bridges"))
    return "It is low, as a leg has to be while the bridges are off; the next self-test tells, or the motors' watch "
           "once a current is asked for.";
  if (wire == "bridge_fault_tim8" && fault == InjectedFault::wire_low) return break_of_tim8;
  if (wire == "bridge_enable")
    return "The chip's own pin is as it has to be. If the bridges see it low, the first heartbeat tells; if high, the "
           "heartbeat that ends takes them off all the same.";
  if (wire == "bridge_heartbeat")
    return "It is low, as it has to be while the bridges are off; the first heartbeat tells.";
  if (wire == "bridge_hold") return "It is low, as it has to be while the bridges are off; the first heartbeat tells.";
  if (wire.starts_with("motor_current"))
    return "No current flows, and it reads none; the next self-test tells, or the motors' watch once a current is "
           "asked for.";
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
  if (put_in.deed == Deed::fast_hand) return "None is known: the speed of each period is watched.";
  if (put_in.deed == Deed::bus_suspended) return host_is_missed;
  const std::string_view of = put_in.of;
  switch (*put_in.fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen: return reason_of_wire(of);
    case InjectedFault::wires_shorted: return "The two agreed, or nothing compares them.";
    case InjectedFault::wire_spikes: return "The inputs' filters and the next look at them bear it.";
    case InjectedFault::encoder_stuck:
      return "It shows by a motor that turns, or presses otherwise again and again, while the joint does not seem to "
             "move.";
    case InjectedFault::encoder_lost_counts:
    case InjectedFault::encoder_slip:
      return "No second sensor knows the joint, and a motor's voltage may differ by more; what is noticed is an angle "
             "far beyond its stop, a jump of 16 counts, and a place that is not the inkwell while its switch is "
             "closed.";
    case InjectedFault::shunt_gain:
      return "Voltage, reading and speed fit within what a sound motor may differ by; the next self-test tells.";
    case InjectedFault::shunt_offset:
    case InjectedFault::shunt_frozen: return "Voltage, reading and speed fit within what a sound motor may differ by.";
    case InjectedFault::shunt_high:
    case InjectedFault::shunt_low: return "None is known: a reading at its rail is more than any sensor can show.";
    case InjectedFault::motor_open:
    case InjectedFault::leg_open: return "While no current is asked of the motor, none is missed.";
    case InjectedFault::motor_shorted:
      return "With a small current its voltage stays within what a sound motor may differ by; the next self-test "
             "tells.";
    case InjectedFault::motor_hot:
      return "The current loop makes up for it, and its voltage stays within what a sound motor may differ by, or its "
             "bound keeps it there; nothing measures the torque.";
    case InjectedFault::leg_high:
    case InjectedFault::leg_low: return "The leg's other switch, at which the bridge trips, was not turned on.";
    case InjectedFault::leg_slow:
      return "The current loop makes up for it, and what the leg takes is within what a sound one may.";
    case InjectedFault::bridge_fault: return "None is known: the timers' break inputs see the wire.";
    case InjectedFault::supply_sag:
    case InjectedFault::supply_spike:
    case InjectedFault::supply_cut: return "The capacitors bear it for that long.";
    case InjectedFault::supply_ripple:
      return "It swings by less than a volt, which sound motors may bring about, or has not swung often enough.";
    case InjectedFault::logic_sag: return "The voltage is above 2.9 V.";
    case InjectedFault::analog_sag: return "Within what a sound regulator and the reference may be off.";
    case InjectedFault::crystal_stop: return "None is known: the clock's own guard sees it.";
    case InjectedFault::crystal_drift: return "Within what the clock and USB bear; no second clock is compared.";
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
      return reason_of_exception(of, "Late by less than what the firmware watches for.");
    case InjectedFault::adc_stopped: return "None is known: each conversion of a current has to be a new one.";
    case InjectedFault::dma_stopped: return "None is known: the age of supply and gimbal is watched.";
    case InjectedFault::ram_bit:
      return "Of the RAM only the interrupts' code and tables and the settings are checked; the byte was not used, or "
             "written anew before.";
    case InjectedFault::flash_bit:
      return "The bit lay outside the image: in the sectors of the stored parameters, or where nothing lies.";
  }
  return "";
}

std::string_view reason_without_force(const CaseFault& put_in, CaseSituation situation) {
  if (put_in.deed == Deed::fast_hand) return "A hand may be as fast as it likes while there is no force.";
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
      return "The two agree while the bridges are off and the hand holds the joint still.";
    case InjectedFault::encoder_stuck: return "The hand holds the joint still, and no motor turns it.";
    case InjectedFault::encoder_lost_counts:
      return "The hand holds the joint still, so that no count comes that could be lost.";
    case InjectedFault::encoder_slip:
      return "Before there is a reference it does not matter; during a self-test, or while another fault is told, the "
             "reference is given up without a fault. Either way the inkwell gives a new one.";
    case InjectedFault::shunt_gain:
    case InjectedFault::shunt_frozen:
      return "No current flows, and it reads none; the next self-test tells, or the motors' watch once a current is "
             "asked for.";
    case InjectedFault::motor_hot:
      return "A motor that is 100 K hotter passes the self-test, and nothing else drives it without force.";
    case InjectedFault::motor_open:
    case InjectedFault::motor_shorted:
    case InjectedFault::leg_open:
    case InjectedFault::leg_slow: return "The bridges are off and no current flows; the next self-test tells.";
    case InjectedFault::leg_high:
    case InjectedFault::leg_low:
      return "The bridge trips when the leg's other switch joins it: in the next self-test, or once the force is on.";
    case InjectedFault::supply_spike:
      if (situation != CaseSituation::fault && situation != CaseSituation::update) return reason_with_force(put_in);
      return "While another fault is told, and in the boot loader, nobody looks at the supply, and it is sound again "
             "afterwards.";
    case InjectedFault::logic_sag:
      if (!is_starting && situation != CaseSituation::update) return reason_with_force(put_in);
      return chip_stands;
    case InjectedFault::crystal_drift:
    case InjectedFault::usb_cut: return no_force_to_lose;
    case InjectedFault::host_silent: return "A host is missed while the force is on only.";
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
  constexpr std::string_view unknown = "None is known: what takes the bridges off is told.";
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
    case InjectedFault::logic_sag: return chip_stands;
    case InjectedFault::crystal_drift:
    case InjectedFault::usb_cut: return usb_gone;
    case InjectedFault::host_silent: return "Nobody asks; it is told once the host asks again.";
    case InjectedFault::core_halted:
      return "A core that stands tells nothing; when it goes on it tells that the bridges were let go.";
    default: break;
  }
  return unknown;
}

}  // namespace inkwell::campaign
