// Actions of the simulated user.
#pragma once

#include <vector>

#include "host/lab/campaign/board_run.hpp"
#include "host/lab/experiment/wall.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::campaign {

// A relaxed hand.
inline constexpr double hand_stiffness_N_per_m = 600, hand_damping_Ns_per_m = 8;

device::Vector3 middle_of_box_m(const protocol::ParameterSet& parameters);
/// Returns the hand target inside the wall for this contact force.
device::Vector3 into_wall_m(const protocol::ParameterSet& parameters, experiment::BoxWall wall, double force_N);
/// Returns the hand target inside the forward wall for this fraction of the force limit.
device::Vector3 beyond_forward_wall_m(const protocol::ParameterSet& parameters, double part_of_limit);
/// Returns the hand path of CaseSituation::motion around this point.
std::vector<device::HandWaypoint> swings(const device::Vector3& middle_m, int count);
/// Returns the hand path for continued use (campaign/run.hpp).
std::vector<device::HandWaypoint> pressing_and_swinging(const protocol::ParameterSet& parameters);
/// Returns a hand path along x, faster than the speed limit.
std::vector<device::HandWaypoint> fling(const device::Vector3& middle_m);
/// Grips the stylus and moves it to the target.
void take_by_hand(BoardRun& board, device::Vector3 target_m, double duration_s);

/// Returns true if a bridge was driven a moment ago, according to `truth` of the control socket.
bool bridges_drive(const nlohmann::json& truth);
/// Clears the fault, references the arm if necessary, and switches the force on. Returns false if the force stays off
/// or no device is connected. Throws device::Error if the device disconnects during the call.
bool regain_force(BoardRun& board);

}  // namespace inkwell::campaign
