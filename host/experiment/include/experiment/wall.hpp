// The walls of the box that the sphere moves in.
#pragma once

#include <string>

#include <protocol/parameters.hpp>
#include <recording/recording.hpp>

namespace inkwell::experiment {

/// One wall of the box.
struct BoxWall {
  int axis = 2;  ///< 0 x, 1 y, 2 z
  int side = 1;  ///< 1 the upper wall, -1 the lower one
  bool operator==(const BoxWall&) const = default;
};

/// "z+" and the like. Throws device::Error.
BoxWall parse_wall(const std::string& name);
std::string wall_name(BoxWall wall);
/// The wall in the arm's plane, away from its base: pushing into it takes no torque about the waist.
BoxWall forward_wall(const protocol::ParameterSet& parameters);
/// A wall that stands upright across that plane: the waist's motor bears it.
BoxWall side_wall(const protocol::ParameterSet& parameters);
/// Where the wall stands along its axis, in metres.
double wall_position_m(const protocol::ParameterSet& parameters, BoxWall wall);
char axis_letter(int axis);
/// The wall that was pushed into deepest. Throws device::Error if there was no contact.
BoxWall pushed_wall(const recording::Recording& recording);

}  // namespace inkwell::experiment
