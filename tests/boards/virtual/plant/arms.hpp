// The two arms of the repository, for tests of what is simulated.
#pragma once

#include <filesystem>

#include <arms/description.hpp>

namespace inkwell::test {

inline arms::Description arm(const char* name) {
  const auto directory = std::filesystem::path(INKWELL_SOURCE_DIRECTORY) / "boards" / "arms";
  return arms::read(directory / name);
}

inline arms::Description omni() { return arm("omni.toml"); }
inline arms::Description paper() { return arm("paper.toml"); }

/// The arm without friction.
inline arms::Description frictionless(arms::Description description) {
  description.simulation.coulomb_friction_Nm = {};
  description.simulation.viscous_friction_Nms_per_rad = {};
  return description;
}

}  // namespace inkwell::test
