// Adds the simulated quantities of each control period to a recording.
#pragma once

#include <vector>

#include "host/client/device/control_client.hpp"
#include "host/client/recording/recording.hpp"

namespace inkwell::experiment {

/// Returns probe position, motor currents and hand force.
std::vector<protocol::SimulatedQuantity> recorded_quantities();

/// Adds columns from a virtual board's trace. Throws device::Error if a quantity or a control period is missing in the
/// trace.
void add_simulated_columns(recording::Recording& recording, const device::Trace& trace,
                           const std::vector<protocol::SimulatedQuantity>& quantities);

}  // namespace inkwell::experiment
