#include "host/companion/command_line/arm_workspace.hpp"

#include <array>

#include "host/client/device/open_arm.hpp"
#include "host/client/installation/installed_paths.hpp"

namespace inkwell::command_line {

using protocol::Parameter;

geometry::Box arm_workspace(const DeviceOptions& options) {
  constexpr std::array minima{Parameter::box_minimum_x_m, Parameter::box_minimum_y_m, Parameter::box_minimum_z_m};
  constexpr std::array maxima{Parameter::box_maximum_x_m, Parameter::box_maximum_y_m, Parameter::box_maximum_z_m};
  geometry::Box box{};
  for (const auto& [parameter, value] :
       device::arm_parameters(options.arm.empty() ? installation::default_arm() : options.arm))
    for (int axis = 0; axis < 3; ++axis) {
      if (parameter == minima[static_cast<std::size_t>(axis)]) box.minimum_m[axis] = static_cast<float>(value);
      if (parameter == maxima[static_cast<std::size_t>(axis)]) box.maximum_m[axis] = static_cast<float>(value);
    }
  return box;
}

}  // namespace inkwell::command_line
