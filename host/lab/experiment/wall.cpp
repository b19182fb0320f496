#include "host/lab/experiment/wall.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

namespace inkwell::experiment {
namespace {

using protocol::Parameter;
using protocol::ParameterSet;

constexpr Parameter wall_parameters[3][2] = {
    {Parameter::box_minimum_x_m, Parameter::box_maximum_x_m},
    {Parameter::box_minimum_y_m, Parameter::box_maximum_y_m},
    {Parameter::box_minimum_z_m, Parameter::box_maximum_z_m},
};

bool has_frame_of_omni(const ParameterSet& parameters) { return parameters[Parameter::frame] == 1.0f; }

}  // namespace

char axis_letter(int axis) { return static_cast<char>('x' + axis); }

BoxWall parse_wall(const std::string& name) {
  if (name.size() == 2 && name[0] >= 'x' && name[0] <= 'z' && (name[1] == '+' || name[1] == '-'))
    return {name[0] - 'x', name[1] == '+' ? 1 : -1};
  throw device::Error(fmt::format("There is no wall {}. Give one of x-, x+, y-, y+, z-, z+.", name));
}

std::string wall_name(BoxWall wall) { return {axis_letter(wall.axis), wall.side > 0 ? '+' : '-'}; }

BoxWall forward_wall(const ParameterSet& parameters) { return {has_frame_of_omni(parameters) ? 2 : 0, 1}; }

BoxWall side_wall(const ParameterSet& parameters) { return {has_frame_of_omni(parameters) ? 0 : 1, 1}; }

double wall_position_m(const ParameterSet& parameters, BoxWall wall) {
  return static_cast<double>(parameters[wall_parameters[wall.axis][wall.side > 0 ? 1 : 0]]);
}

BoxWall pushed_wall(const recording::StoredRecording& recording) {
  std::vector<std::size_t> columns;
  for (int axis = 0; axis < 3; ++axis)
    columns.push_back(recording.column_of(of_axis(protocol::Signal::penetration_x_m, axis)));
  const recording::SampleRange all{0, recording.size()};
  const auto penetration_m = recording.bands(columns, {&all, 1}).front();
  double deepest_m = 0;
  BoxWall wall;
  for (int axis = 0; axis < 3; ++axis)
    for (const double extreme_m : {penetration_m[static_cast<std::size_t>(axis)].minimum,
                                   penetration_m[static_cast<std::size_t>(axis)].maximum}) {
      if (!(std::abs(extreme_m) > deepest_m)) continue;
      deepest_m = std::abs(extreme_m);
      // The penetration vector points out of the wall, into the box.
      wall = {axis, extreme_m < 0 ? 1 : -1};
    }
  if (deepest_m == 0) throw device::Error("The sphere touches no wall in this recording. Record a push into a wall.");
  return wall;
}

}  // namespace inkwell::experiment
