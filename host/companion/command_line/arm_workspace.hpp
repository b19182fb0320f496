// Workspace of the selected arm.
#pragma once

#include "host/client/command_line/connection.hpp"
#include "host/geometry/mesh.hpp"

namespace inkwell::command_line {

/// The box in which the arm moves, from the description of the arm. Needs no device.
geometry::Box arm_workspace(const DeviceOptions& options);

}  // namespace inkwell::command_line
