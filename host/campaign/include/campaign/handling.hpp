// What a user does with hand and host: takes the stylus, presses it into a wall, switches the force on again.
#pragma once

#include <vector>

#include <campaign/board_run.hpp>
#include <experiment/wall.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::campaign {

// A relaxed hand.
inline constexpr double hand_stiffness_N_per_m = 600, hand_damping_Ns_per_m = 8;

device::Vector3 middle_of_box_m(const protocol::ParameterSet& parameters);
/// Where the hand pulls to, beyond the wall, so that hand and wall in series press with this force.
device::Vector3 into_wall_m(const protocol::ParameterSet& parameters, experiment::BoxWall wall, double force_N);
/// The wall in front of the arm, pressed with this part of the force limit.
device::Vector3 beyond_forward_wall_m(const protocol::ParameterSet& parameters, double part_of_limit);
/// From one side of this point to the other and back, as in CaseSituation::motion.
std::vector<device::HandWaypoint> swings(const device::Vector3& middle_m, int count);
/// To the middle, then `use_presses` times into the wall in front and the one to the side, then `use_swings`
/// (campaign/run.hpp).
std::vector<device::HandWaypoint> pressing_and_swinging(const protocol::ParameterSet& parameters);
/// Back, along x, and then from there to the other side of this point faster than any force is given at.
std::vector<device::HandWaypoint> fling(const device::Vector3& middle_m);
/// Takes the stylus where it is, out of the inkwell if it is there, and brings it to the target.
void take_by_hand(BoardRun& board, device::Vector3 target_m, double duration_s);

/// By `truth` of the control socket: a leg was at the supply just now.
bool bridges_drive(const nlohmann::json& truth);
/// Clears the fault and switches the force on, by way of the inkwell if the board does not know where the arm is. False
/// if it does not go on or the device is gone; throws device::Error if it goes away meanwhile.
bool regains_force(BoardRun& board);

}  // namespace inkwell::campaign
