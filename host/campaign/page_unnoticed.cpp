#include "page_unnoticed.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <campaign/run.hpp>

namespace inkwell::campaign {
namespace {

/// Why a wire may be broken unnoticed, by what it is for.
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
  if (wire.starts_with("motor_current"))
    return "The reading stays near what is asked for, or what it leads to within what a hot motor may differ by.";
  if (wire.starts_with("gimbal")) return "The stylus's angles move no motor; only their being measured is watched.";
  if (wire == "supply") return "It reads a sound supply.";
  if (wire == "usb_supply") return "It stands as with the cable in.";
  return "A switch that is open or closed looks like one that is let go of or pressed; the inkwell's is told where "
         "it is closed elsewhere.";
}

/// Why a fault may pass unnoticed with the force on, as far as its row of the table tells.
std::string_view reason(const CaseFault& fault) {
  using protocol::InjectedFault;
  switch (*fault.fault) {
    case InjectedFault::wire_open:
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen: return reason_of_wire(fault.of);
    case InjectedFault::wires_shorted: return "The two agreed, or nothing compares them.";
    case InjectedFault::wire_spikes: return "The inputs' filters and the next look at them bear it.";
    case InjectedFault::encoder_stuck:
      return "It shows by a motor that turns, or presses otherwise again and again, while the joint does not seem to "
             "move.";
    case InjectedFault::encoder_lost_counts:
    case InjectedFault::encoder_slip:
      return "No second sensor knows the joint, and a motor's voltage may differ by more; what is noticed is an "
             "angle far beyond its stop, a jump of 16 counts, and a place that is not the inkwell while its switch is "
             "closed.";
    case InjectedFault::shunt_gain:
      return "Voltage, reading and speed fit within what a hot motor may differ by; the next self-test tells.";
    case InjectedFault::shunt_offset:
    case InjectedFault::shunt_frozen: return "Voltage, reading and speed fit within what a hot motor may differ by.";
    case InjectedFault::shunt_high:
    case InjectedFault::shunt_low: return "None is known: a reading at its rail is more than any sensor can show.";
    case InjectedFault::motor_open:
    case InjectedFault::leg_open: return "While no current is asked of the motor, none is missed.";
    case InjectedFault::motor_shorted:
      return "With a small current its voltage stays within what a sound motor may differ by; the next self-test "
             "tells.";
    case InjectedFault::motor_hot:
      return "The current loop makes up for it, and its voltage stays within what a sound motor may differ by; nothing "
             "measures the torque.";
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
    case InjectedFault::logic_sag: return "The voltage is above 2.9 V, or it was over before the main loop looked.";
    case InjectedFault::analog_sag: return "Within what a sound regulator and the reference may be off.";
    case InjectedFault::crystal_stop: return "None is known: the clock's own guard sees it.";
    case InjectedFault::crystal_drift: return "Within what the clock and USB bear; no second clock is compared.";
    case InjectedFault::usb_cut:
    case InjectedFault::host_silent: return "None is known: a host that is not heard is missed.";
    case InjectedFault::core_stalled:
      return "None is known: the heartbeat stops with the core, and the watchdog is not fed.";
    case InjectedFault::core_halted: return "None is known: the heartbeat and the timers stop with the core.";
    case InjectedFault::main_loop_stalled: return "None is known: the control interrupt misses it.";
    case InjectedFault::program_astray:
      return "The code that it came to returned to the main loop, and had changed nothing that is checked.";
    case InjectedFault::exception_lost:
      return "The force does not need it; a host that it keeps from being heard is missed after host_timeout_s, 2 s in "
             "these cases.";
    case InjectedFault::exception_late: return "Late by less than what the firmware watches for.";
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

/// What was noticed while the arm was used on, of the cases in which it was.
class InUse {
 public:
  void see(const Result& result) {
    if (!result.error.empty()) return;
    if (!result.peak_force_in_use_N) {
      ++not_used_;
      return;
    }
    ++used_;
    peak_N_ = std::max(peak_N_, *result.peak_force_in_use_N);
    if (!result.noticed_in_use_s) return;
    ++noticed_;
    names_.insert(result.noticed_in_use_as);
    after_s_ = std::max(after_s_, *result.noticed_in_use_s);
  }
  unsigned used() const { return used_; }
  unsigned noticed() const { return noticed_; }
  double peak_N() const { return peak_N_; }
  std::string text() const {
    if (used_ == 0) return "not used";
    const std::string left_out = not_used_ == 0 ? "" : fmt::format("; {} not used", not_used_);
    if (noticed_ == 0) return "-" + left_out;
    return fmt::format("{}{}, {:.2f} s{}", fmt::join(names_, "; "),
                       noticed_ < used_ ? fmt::format(" ({} of {})", noticed_, used_) : "", after_s_, left_out);
  }

 private:
  unsigned used_ = 0, not_used_ = 0, noticed_ = 0;
  double peak_N_ = 0, after_s_ = 0;
  std::set<std::string> names_;
};

InUse sound_in_use(const Groups& groups) {
  InUse sound;
  for (const CaseSituation situation : situations)
    if (const auto* results = find(groups, "none", situation))
      for (const Result& result : *results) sound.see(result);
  return sound;
}

}  // namespace

std::string unnoticed(const Groups& groups, const std::vector<CaseFault>& faults) {
  std::string text = fmt::format(
      "\n## Not noticed\n\nWith the force on, in at least one of the cases that were run, the bridges stayed on and no "
      "fault was told. The hand then went on: for {} s as before, then it pressed {} times into the wall in front with "
      "the force limit and swung {} times. What was told meanwhile stands in the third column, with the longest time "
      "since it went on; the fourth is what the hand felt at most.",
      goes_on_s, use_presses, use_swings);
  if (const InUse sound = sound_in_use(groups); sound.used() > 0)
    text += fmt::format(" Without a fault it felt {:.2f} N at most, and a fault was told in {} of {} cases.",
                        sound.peak_N(), sound.noticed(), sound.used());
  text +=
      "\n\n| fault | situations | noticed in use | peak force in use, N | reason |\n| --- | --- | --- | --- | --- |\n";
  for (const CaseFault& fault : faults) {
    if (!fault.fault) continue;
    std::vector<std::string> where;
    InUse in_use;
    for (const CaseSituation situation : situations) {
      const auto* results = find(groups, fault.name(), situation);
      if (results == nullptr || !is_active(situation)) continue;
      std::size_t run = 0, missed = 0;
      for (const Result& result : *results) {
        if (!result.error.empty()) continue;
        ++run;
        if (!is_unnoticed(result)) continue;
        ++missed;
        in_use.see(result);
      }
      if (missed > 0)
        where.push_back(missed == run ? std::string(name_of(situation))
                                      : fmt::format("{} ({} of {})", name_of(situation), missed, run));
    }
    if (where.empty()) continue;
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", fault.name(), fmt::join(where, ", "), in_use.text(),
                        in_use.used() == 0 ? "-" : fmt::format("{:.2f}", in_use.peak_N()), reason(fault));
  }
  return text;
}

}  // namespace inkwell::campaign
