#include "host/lab/campaign/cases.hpp"

#include <functional>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include "boards/known/boards.hpp"
#include "boards/stm32f405/core/exception_numbers.hpp"
#include "host/lab/campaign/run.hpp"
#include "host/lab/campaign/wires.hpp"

namespace inkwell::campaign {
namespace {

using protocol::InjectedFault;
using protocol::InjectionLocation;

/// The campaign tests only the second of three equivalent wires.
bool is_tried(std::string_view wire) {
  if (wire.find("[0]") != std::string_view::npos || wire.find("[2]") != std::string_view::npos) return false;
  return wire_of(wire) != Wire::other;
}

constexpr std::string_view wires_that_touch[] = {"encoders[1].a+encoders[1].b", "bridges[1].leg_a+bridges[1].leg_b",
                                                 "motor_current[1]+motor_current[2]"};
constexpr std::string_view wires_with_spikes[] = {"encoders[1].a", "encoders[1].b", "bridge_fault_tim1",
                                                  "bridge_fault_tim8", "inkwell_switch"};
/// The firmware handles these exceptions. The main loop polls USB.
constexpr unsigned exceptions[] = {virtual_board::exception_pendsv,
                                   virtual_board::exception_of(virtual_board::voltage_detector_position),
                                   virtual_board::exception_of(virtual_board::converters_position)};

/// Additional amounts for injected faults.
constexpr struct {
  InjectedFault fault;
  double amount;
} more_amounts[] = {{InjectedFault::shunt_gain, 2},
                    {InjectedFault::logic_sag, 2.86},  // below 2.9 V, above the brown-out level
                    {InjectedFault::analog_sag, 3.5},
                    {InjectedFault::main_loop_stalled, 0.012}};  // detected, but shorter than the watchdog time-out

std::vector<std::string> tried_locations(InjectedFault fault) {
  std::vector<std::string> locations;
  switch (protocol::info(fault).location) {
    case InjectionLocation::none:
    case InjectionLocation::address: return {""};
    case InjectionLocation::motor: return {"2"};
    case InjectionLocation::leg: return {"2A", "2B"};
    case InjectionLocation::converter: return {"1", "2", "3"};
    case InjectionLocation::wires: locations.assign(std::begin(wires_that_touch), std::end(wires_that_touch)); break;
    case InjectionLocation::exception:
      for (const unsigned exception : exceptions) locations.push_back(std::to_string(exception));
      break;
    case InjectionLocation::wire:
      if (fault == InjectedFault::wire_spikes) {
        locations.assign(std::begin(wires_with_spikes), std::end(wires_with_spikes));
      } else {
        for (const auto& use : board::default_board.pin_uses())
          if (is_tried(use.name)) locations.emplace_back(use.name);
      }
      break;
  }
  return locations;
}

}  // namespace

std::string_view name_of(CaseSituation situation) {
  constexpr std::string_view names[] = {"unreferenced", "ready",   "rest",    "wall",  "motion", "ramping",
                                        "limited",      "landing", "testing", "fault", "update", "starting"};
  return names[static_cast<std::size_t>(situation)];
}

std::optional<CaseSituation> find_situation(std::string_view name) {
  for (const CaseSituation situation : situations)
    if (name_of(situation) == name) return situation;
  return std::nullopt;
}

std::string meaning_of(CaseSituation situation) {
  switch (situation) {
    case CaseSituation::unreferenced:
      return "The stylus has been outside the inkwell since power-on, so the board does not know the arm position. The "
             "hand holds the stylus.";
    case CaseSituation::ready:
      return "The pose is valid and the force is off. The hand holds the stylus in free space.";
    case CaseSituation::rest: return "The force is on. The hand holds the stylus at rest in free space.";
    case CaseSituation::wall:
      return "The force is on. The hand presses the stylus into a wall with the highest stiffness.";
    case CaseSituation::motion:
      return fmt::format(
          "The force is on. The hand swings the stylus through free space by {:.0f} mm in {} s, and all joints move.",
          2e3 * swing_m, swing_s);
    case CaseSituation::ramping:
      return "The hand presses the stylus into the stiff wall while the force increases at the lowest rate.";
    case CaseSituation::limited:
      return "The force is on. The hand presses the stylus into the stiff wall until the force limit acts.";
    case CaseSituation::landing:
      return "The hand presses the stylus into the stiff wall while the force decreases at the lowest rate. The use "
             "does not continue afterwards.";
    case CaseSituation::testing:
      return "The hand holds the stylus in free space. The fault occurs during the self-test pulses of the first "
             "motor. Without a fault, the bridges also switch off after the pulses.";
    case CaseSituation::fault:
      return fmt::format(
          "The hand holds the stylus in free space. The force was on until the board detected a silent host. The "
          "injected fault occurs while `host_silent` is still reported. The host clears `host_silent` {} s later, "
          "while the injected fault is still present.",
          observed_s);
    case CaseSituation::update:
      return "The hand holds the stylus in free space. The host has commanded the board to store its parameters and to "
             "start its boot loader. The write delays the boot loader by about 80 ms; without a write, it starts "
             "within 2 ms. The fault occurs in the first 50 ms and remains present in the boot loader. The boot loader "
             "then starts the firmware, which reports the fault.";
    case CaseSituation::starting:
      return "The hand holds the stylus outside the inkwell. At the first instant the fault is present before "
             "power-on; at the other instants it occurs during start-up. Without a fault, the self-test pulses switch "
             "the bridges on briefly.";
  }
  return "";
}

std::string CaseFault::name() const {
  switch (deed) {
    case Deed::nothing: break;
    case Deed::fast_hand: return "fast_hand";
    case Deed::bus_suspended: return "bus_suspended";
    case Deed::models_lost: return "models_lost";
    case Deed::models_stale: return "models_stale";
    case Deed::models_malformed: return "models_malformed";
    case Deed::models_contradictory: return "models_contradictory";
  }
  if (!fault) return "none";
  std::string name(protocol::info(*fault).name);
  if (!of.empty()) name += ":" + of;
  if (amount) name += fmt::format("={}", *amount);
  if (for_s) name += fmt::format("+{}", *for_s);
  return name;
}

std::string Case::name() const { return fmt::format("{} {} {}", fault.name(), name_of(situation), phase); }

std::vector<CaseFault> case_faults() {
  std::vector<CaseFault> faults{{}};
  for (std::size_t i = 0; i < protocol::injection_table.size(); ++i) {
    const auto fault = static_cast<InjectedFault>(i);
    for (std::string& of : tried_locations(fault)) {
      CaseFault made{.fault = fault, .of = std::move(of)};
      if (fault == InjectedFault::supply_spike) made.for_s = 0.005;
      if (fault == InjectedFault::encoder_lost_counts) made.amount = 0.1;
      if (fault == InjectedFault::encoder_slip) made.amount = 400;
      faults.push_back(made);
      for (const auto& more : more_amounts)
        if (more.fault == fault) {
          made.amount = more.amount;
          faults.push_back(made);
        }
    }
  }
  faults.push_back({.deed = Deed::bus_suspended});
  faults.push_back({.deed = Deed::fast_hand});
  for (const Deed deed : {Deed::models_lost, Deed::models_stale, Deed::models_malformed, Deed::models_contradictory})
    faults.push_back({.deed = deed});
  return faults;
}

CaseFault at_another(CaseFault fault, unsigned number) {
  if (!fault.fault) return fault;
  const auto location = protocol::info(*fault.fault).location;
  if (location == InjectionLocation::motor || location == InjectionLocation::leg)
    fault.of[0] = static_cast<char>('0' + number);
  if (location != InjectionLocation::wire && location != InjectionLocation::wires) return fault;
  // A name of two adjacent wires contains the indices [1] and [2]. Each index changes cyclically.
  for (std::size_t at = 0; (at = fault.of.find('[', at)) != std::string::npos; ++at) {
    char& index = fault.of[at + 1];
    index = static_cast<char>('0' + (static_cast<unsigned>(index - '0') + number + 1) % 3);
  }
  return fault;
}

bool is_of_three(const CaseFault& fault) { return at_another(fault, 1).name() != fault.name(); }

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  unsigned number = 0;
  for (const CaseFault& fault : case_faults())
    for (const CaseSituation situation : situations) {
      for (unsigned phase = 1; phase <= phases; ++phase) cases.push_back({++number, fault, situation, phase});
      if (!is_of_three(fault)) continue;
      // In the self-test, the pulses of motor 1 come first, so motor 1 uses the earliest instant. The instant before
      // power-on is not used.
      for (const unsigned other : {1u, 3u}) {
        const unsigned phase = other == 1 ? 3 : 2;
        cases.push_back({++number, at_another(fault, other), situation, phase});
      }
    }
  return cases;
}

namespace {

struct NamedFault {
  CaseFault fault, listed;
};

const std::map<std::string, NamedFault, std::less<>>& faults_by_name() {
  static const auto faults = [] {
    std::map<std::string, NamedFault, std::less<>> by_name;
    for (const CaseFault& fault : case_faults()) {
      by_name[fault.name()] = {fault, fault};
      if (!is_of_three(fault)) continue;
      for (const unsigned other : {1u, 3u}) {
        const CaseFault moved = at_another(fault, other);
        by_name[moved.name()] = {moved, fault};
      }
    }
    return by_name;
  }();
  return faults;
}

}  // namespace

CaseFault listed_fault(const CaseFault& fault) {
  const auto found = faults_by_name().find(fault.name());
  return found == faults_by_name().end() ? fault : found->second.listed;
}

std::optional<CaseFault> find_fault(std::string_view name) {
  const auto found = faults_by_name().find(name);
  return found == faults_by_name().end() ? std::nullopt : std::optional(found->second.fault);
}

}  // namespace inkwell::campaign
