// Walls of the box around the workspace.
#pragma once

#include <string>

#include "host/client/recording/stored_recording.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::experiment {

struct BoxWall {
  int axis = 2;  ///< 0 x, 1 y, 2 z
  int side = 1;  ///< 1 the upper wall, -1 the lower one
  bool operator==(const BoxWall&) const = default;
};

/// "z+" and the like. Throws device::Error.
BoxWall parse_wall(const std::string& name);
std::string wall_name(BoxWall wall);
/// Returns the wall opposite the arm's base. A push into the wall requires no waist torque.
BoxWall forward_wall(const protocol::ParameterSet& parameters);
/// Returns a side wall. The waist motor supplies the wall force.
BoxWall side_wall(const protocol::ParameterSet& parameters);
/// Position of the wall along its axis, in meters.
double wall_position_m(const protocol::ParameterSet& parameters, BoxWall wall);
char axis_letter(int axis);
/// The wall with the deepest penetration. Throws device::Error without contact.
BoxWall pushed_wall(const recording::StoredRecording& recording);

}  // namespace inkwell::experiment
