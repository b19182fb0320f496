// Capabilities of an arm, from its parameters.
#pragma once

#include <array>
#include <optional>

#include <inkwell/inkwell.h>
#include "firmware/control/signal_path/kinematics.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::library {

inkwell_abilities abilities_of(const protocol::ParameterSet& parameters, const control::Arm& geometry);

/// Returns the force at the probe that requires these joint torques (tau = J^T F). Returns none at a singularity, such
/// as the stretched arm.
std::optional<std::array<double, 3>> force_of_torques(const control::Jacobian& jacobian, const double (&torque_Nm)[3]);

}  // namespace inkwell::library
