// Actions of the user: gripping the stylus, pressing it into a wall, switching the force on.
#pragma once

#include <vector>

#include "host/lab/campaign/board_run.hpp"
#include "host/lab/experiment/wall.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::campaign {

// A relaxed hand.
inline constexpr double hand_stiffness_N_per_m = 600, hand_damping_Ns_per_m = 8;

device::Vector3 middle_of_box_m(const protocol::ParameterSet& parameters);
/// Target of the hand inside the wall, so that hand and wall in series exert this force.
device::Vector3 into_wall_m(const protocol::ParameterSet& parameters, experiment::BoxWall wall, double force_N);
/// Target inside the forward wall for this fraction of the force limit.
device::Vector3 beyond_forward_wall_m(const protocol::ParameterSet& parameters, double part_of_limit);
/// Returns a path that swings back and forth around this point, as in CaseSituation::motion.
std::vector<device::HandWaypoint> swings(const device::Vector3& middle_m, int count);
/// Returns a path to the middle, then `use_presses` presses into the forward and the side wall, and then `use_swings`
/// swings (campaign/run.hpp).
std::vector<device::HandWaypoint> pressing_and_swinging(const protocol::ParameterSet& parameters);
/// Returns a path back along x and then past this point to the other side, faster than the speed limit.
std::vector<device::HandWaypoint> fling(const device::Vector3& middle_m);
/// Grips the stylus at its position or in the inkwell, and moves it to the target.
void take_by_hand(BoardRun& board, device::Vector3 target_m, double duration_s);

/// True if the control socket's `truth` shows that a leg was driven high a moment ago.
bool bridges_drive(const nlohmann::json& truth);
/// Clears the fault and switches the force on, after a move to the inkwell if the arm is unreferenced. Returns false if
/// the force stays off or there is no device. Throws device::Error if the device disconnects meanwhile.
bool regains_force(BoardRun& board);

}  // namespace inkwell::campaign
