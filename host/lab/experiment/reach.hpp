// Checks whether the arm can reach a position within its joint stops.
#pragma once

#include "host/client/device/control_client.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::experiment {

/// Distance from the target to the nearest position that the probe can reach; nearly 0 for a reachable target.
double distance_to_reach_m(const protocol::ParameterSet& parameters, const device::Vector3& target_m);

}  // namespace inkwell::experiment
