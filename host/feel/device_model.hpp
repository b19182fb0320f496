// Local models and materials for the device.
#pragma once

#include <vector>

#include "host/client/device/program_force.hpp"
#include "host/contact/scene.hpp"
#include "host/contact/step.hpp"

namespace inkwell::feel {

/// The device renders the model for protocol::local_model_life_maximum_ms without a newer model.
device::LocalModel device_model(const contact::LocalModel& model);

/// All materials of the scene, with their numbers.
std::vector<device::Material> device_materials(const contact::Scene& scene);

}  // namespace inkwell::feel
