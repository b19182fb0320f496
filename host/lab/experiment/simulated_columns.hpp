// Adds the simulated quantities of each control period to a recording.
#pragma once

#include <vector>

#include "host/client/device/control_client.hpp"
#include "host/client/recording/recording.hpp"

namespace inkwell::experiment {

/// Probe position, motor currents and hand force, as references for the firmware's values.
std::vector<protocol::SimulatedQuantity> recorded_quantities();

/// Adds columns from a virtual board's trace, matched by control period. Throws device::Error if the trace does not
/// contain a quantity, or does not cover a period of the recording.
void add_simulated_columns(recording::Recording& recording, const device::Trace& trace,
                           const std::vector<protocol::SimulatedQuantity>& quantities);

}  // namespace inkwell::experiment
