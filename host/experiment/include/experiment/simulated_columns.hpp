// What the simulation knew at every control period of a recording, put beside its signals.
#pragma once

#include <vector>

#include <device/control_client.hpp>
#include <recording/recording.hpp>

namespace inkwell::experiment {

/// The probe, the motors' currents and the force of the hand: what the figures of the firmware are compared with.
std::vector<protocol::SimulatedQuantity> recorded_quantities();

/// Adds columns from a virtual board's trace, matched by control period. Throws device::Error if the trace does not
/// know a quantity, or does not cover a period of the recording.
void add_simulated_columns(recording::Recording& recording, const device::Trace& trace,
                           const std::vector<protocol::SimulatedQuantity>& quantities);

}  // namespace inkwell::experiment
