// The cases of the fault campaign.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/injections.hpp"

namespace inkwell::campaign {

/// Situation of the arm at the injection of the fault.
enum class CaseSituation : std::uint8_t {
  unreferenced,  ///< out of the inkwell since power-on: no force
  ready,         ///< the hand holds the stylus, the force is off
  rest,          ///< like `ready` with the force on, in free space
  wall,          ///< pressed into a wall with the highest stiffness
  motion,        ///< the force is on, during a fast swing through free space
  ramping,       ///< pressed into the wall while the force increases
  limited,       ///< pressed into the wall until the force limit acts
  landing,       ///< pressed into the wall while the force decreases
  testing,       ///< like `ready`, during the pulses of the self-test
  fault,         ///< another fault has switched the force off and is still reported
  update,        ///< during the transition to the boot loader, and in the boot loader
  starting,      ///< out of the inkwell, before power-on and during start-up
};
inline constexpr CaseSituation situations[] = {
    CaseSituation::unreferenced, CaseSituation::ready,   CaseSituation::rest,    CaseSituation::wall,
    CaseSituation::motion,       CaseSituation::ramping, CaseSituation::limited, CaseSituation::landing,
    CaseSituation::testing,      CaseSituation::fault,   CaseSituation::update,  CaseSituation::starting};
std::string_view name_of(CaseSituation situation);
std::optional<CaseSituation> find_situation(std::string_view name);
/// Description in one sentence with figures.
std::string meaning_of(CaseSituation situation);
/// Returns true if the host has switched the force on.
constexpr bool is_active(CaseSituation situation) {
  return situation >= CaseSituation::rest && situation <= CaseSituation::landing;
}
constexpr bool is_pressed(CaseSituation situation) {
  return is_active(situation) && situation != CaseSituation::rest && situation != CaseSituation::motion;
}

/// In `motion` the hand swings by `swing_m` along each axis, and half a swing lasts `swing_s`.
inline constexpr double swing_m = 0.03, swing_s = 0.10;

/// In `fast_hand` the hand moves by `fling_m` along x within `fling_s`.
inline constexpr double fling_m = 0.14, fling_s = 0.085;

/// Number of instants. The first instant of `starting` is before power-on.
inline constexpr unsigned phases = 3;

/// Events other than injected faults.
enum class Deed : std::uint8_t {
  nothing,
  fast_hand,
  bus_suspended,  ///< the PC suspends, or the last program that uses the board through USB/IP is killed
  // A program sends a local model each millisecond. After a third of the observation, its models are wrong:
  models_lost,           ///< the program sends nothing
  models_stale,          ///< the models answer an old pose
  models_malformed,      ///< the models have a material that does not exist
  models_contradictory,  ///< each model contradicts the previous one
};
constexpr bool is_about_models(Deed deed) { return deed >= Deed::models_lost; }

/// An injected fault with its location, or another event (Deed). The control case has neither a fault nor a Deed.
struct CaseFault {
  std::optional<protocol::InjectedFault> fault;
  std::string of;
  std::optional<double> amount;
  std::optional<double> for_s;
  Deed deed = Deed::nothing;

  bool is_fault_free() const { return !fault && deed == Deed::nothing; }
  std::string name() const;  ///< in the format of --inject, or `none`, or the name of the event

  auto operator<=>(const CaseFault&) const = default;
};

struct Case {
  unsigned number;  ///< from 1; constant for the same situations and the same table of faults and locations
  CaseFault fault;
  CaseSituation situation;
  unsigned phase;  ///< 1 to phases

  std::string name() const;
};

/// Returns the control case, then the faults, then the other events. If the arm has three equivalent parts, the list
/// contains the part of motor 2, because motor 2 carries the load at the wall.
std::vector<CaseFault> case_faults();
/// Returns the same fault at part `number` (1 to 3): motor, leg, encoder, current sensor or gimbal potentiometer. If
/// the arm has only one part of the kind, returns the fault unchanged.
CaseFault at_another(CaseFault fault, unsigned number);
bool is_of_three(const CaseFault& fault);
/// Returns a case for each fault, situation and instant. The first and third of three equivalent parts have only one
/// instant.
std::vector<Case> all_cases();
/// If `fault` affects one of three equivalent parts, returns the fault at the part in case_faults().
CaseFault listed_fault(const CaseFault& fault);
/// Returns std::nullopt if no case has a fault with this name.
std::optional<CaseFault> find_fault(std::string_view name);

}  // namespace inkwell::campaign
