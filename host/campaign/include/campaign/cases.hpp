// The fault campaign as a list of jobs: every fault, in every situation of the arm, at random instants.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <protocol/injections.hpp>

namespace inkwell::campaign {

/// What the arm does when the fault comes.
enum class CaseSituation : std::uint8_t {
  unreferenced,  ///< out of the inkwell since the start: no force
  ready,         ///< the hand holds it, the force is off
  rest,          ///< the same with the force on, in free space
  wall,          ///< pressed into a wall of the highest stiffness
  motion,        ///< the force on, swung fast through free space
  ramping,       ///< pressed into that wall while the force rises
  limited,       ///< pressed into it so far that the force limit holds back
  landing,       ///< pressed into it while the force falls
  testing,       ///< ready, while the self-test makes its pulses
  fault,         ///< another fault took the force away and is still told
  update,        ///< on its way to the boot loader, and in it
  starting,      ///< out of the inkwell, from before the power comes and while the board starts
};
inline constexpr CaseSituation situations[] = {
    CaseSituation::unreferenced, CaseSituation::ready,   CaseSituation::rest,    CaseSituation::wall,
    CaseSituation::motion,       CaseSituation::ramping, CaseSituation::limited, CaseSituation::landing,
    CaseSituation::testing,      CaseSituation::fault,   CaseSituation::update,  CaseSituation::starting};
std::string_view name_of(CaseSituation situation);
/// A sentence with its figures.
std::string meaning_of(CaseSituation situation);
/// The hand feels a force. The self-test's pulses are none.
constexpr bool is_active(CaseSituation situation) {
  return situation >= CaseSituation::rest && situation <= CaseSituation::landing;
}
constexpr bool is_pressed(CaseSituation situation) {
  return is_active(situation) && situation != CaseSituation::rest && situation != CaseSituation::motion;
}

/// The swing of `motion`: to either side, along all axes; from one side to the other.
inline constexpr double swing_m = 0.03, swing_s = 0.10;

/// The fling of `fast_hand`: so far along x, within this time.
inline constexpr double fling_m = 0.14, fling_s = 0.085;

/// How many instants. Of `starting` the first is before the power comes.
inline constexpr unsigned phases = 3;

/// What is done to a board and an arm that are sound.
enum class Deed : std::uint8_t {
  nothing,
  fast_hand,      ///< the hand flings the arm
  bus_suspended,  ///< the PC goes to sleep, or over USB/IP the last program that uses the board is killed
};

/// A fault at a place, or a deed; neither is the control, in which nothing is put in.
struct CaseFault {
  std::optional<protocol::InjectedFault> fault;
  std::string of;
  std::optional<double> amount;
  std::optional<double> for_s;
  Deed deed = Deed::nothing;

  bool is_none() const { return !fault && deed == Deed::nothing; }
  std::string name() const;  ///< as --inject writes it, `none`, `bus_suspended` or `fast_hand`
};

struct Case {
  unsigned number;  ///< from 1 on; the same as long as situations, the table of faults and their places are
  CaseFault fault;
  CaseSituation situation;
  unsigned phase;  ///< 1 to phases

  std::string name() const;
};

/// The control first, the deeds last. What there are three of is listed at the second motor, which bears the load at
/// the wall.
std::vector<CaseFault> case_faults();
/// One of these faults as it is at another of three that are alike (1 to 3): motor, leg, encoder, current sensor,
/// potentiometer of the gimbal. What there is only one of stays as it is.
CaseFault at_another(CaseFault fault, unsigned number);
bool is_of_three(const CaseFault& fault);
/// In each situation each listed fault at each instant; after these, of what there are three of, the first and the
/// third at one.
std::vector<Case> all_cases();
/// Under which name the list has a fault that is at another of three; else the name as it is.
std::string listed_name(const std::string& name);

}  // namespace inkwell::campaign
