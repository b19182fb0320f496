// The fault campaign as a list of jobs: every fault, in every situation of the arm, at three random instants.
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
};
inline constexpr CaseSituation situations[] = {CaseSituation::unreferenced, CaseSituation::ready, CaseSituation::rest,
                                               CaseSituation::wall, CaseSituation::motion};
std::string_view name_of(CaseSituation situation);
/// A sentence with its figures.
std::string meaning_of(CaseSituation situation);
constexpr bool is_active(CaseSituation situation) { return situation >= CaseSituation::rest; }

/// The swing of `motion`: to either side, along all axes; from one side to the other.
inline constexpr double swing_m = 0.03, swing_s = 0.10;

inline constexpr unsigned phases = 3;

/// A fault at a place; none is the control, in which nothing is put in.
struct CaseFault {
  std::optional<protocol::InjectedFault> fault;
  std::string of;
  std::optional<double> amount;
  std::optional<double> for_s;

  std::string name() const;  ///< as --inject writes it
};

struct Case {
  unsigned number;  ///< from 1 on; the same as long as the table of faults is
  CaseFault fault;
  CaseSituation situation;
  unsigned phase;  ///< 1 to phases

  std::string name() const;
};

/// The control first. Of three motors that are wired alike the second stands for all: it bears the load at the wall.
std::vector<CaseFault> case_faults();
std::vector<Case> all_cases();

}  // namespace inkwell::campaign
