// Named materials.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "host/contact/scene.hpp"

namespace inkwell::feel {

struct NamedMaterial {
  std::string_view name;
  contact::Material properties;
};

/// All materials, for an arm with a force limit of 3.3 N. Their stiffness is at most the maximum of the parameter
/// wall_stiffness_N_per_m.
std::span<const NamedMaterial> materials();

/// Returns nullptr for an unknown name.
const NamedMaterial* find_material(std::string_view name);

/// Names of all materials, separated by commas.
std::string material_names();

}  // namespace inkwell::feel
