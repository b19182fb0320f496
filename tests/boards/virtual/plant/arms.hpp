// Arm descriptions of this repository, for tests of the simulation.
#pragma once

#include <filesystem>
#include <vector>

#include "boards/arms/description.hpp"
#include "boards/omni_driver/facts.hpp"
#include "boards/virtual/plant/imperfections.hpp"

namespace inkwell::test {

inline std::filesystem::path arms_directory() {
  return std::filesystem::path(INKWELL_SOURCE_DIRECTORY) / "boards" / "arms";
}

inline std::vector<arms::Description> all_arms() {
  std::vector<arms::Description> all;
  for (const auto& file : std::filesystem::directory_iterator(arms_directory()))
    if (file.path().extension() == ".toml") all.push_back(arms::read(file.path()));
  return all;
}
inline arms::Description omni() { return arms::read(arms_directory() / "omni.toml"); }
inline arms::Description paper() { return arms::read(arms_directory() / "paper.toml"); }

/// Absolute gear ratio times absolute torque constant of motor 0, 1 or 2.
inline double torque_Nm_per_A(const arms::Description& arm, unsigned motor) {
  const auto& p = arm.parameters;
  return static_cast<double>(p[of_axis(protocol::Parameter::gear_ratio_1, motor)]) *
         static_cast<double>(p[of_axis(protocol::Parameter::torque_constant_1_Nm_per_A, motor)]);
}

/// Winding resistance, equal for all motors.
inline double winding_ohm(const arms::Description& arm) {
  return static_cast<double>(arm.parameters[protocol::Parameter::motor_resistance_1_ohm]);
}

/// Total resistance in the motor's current path: winding, shunt and the switches of both half bridges.
inline double circuit_ohm(const arms::Description& arm) {
  return winding_ohm(arm) + static_cast<double>(board::omni_driver.shunt_ohm) +
         2.0 * virtual_board::Imperfections{}.leg_resistance_ohm;
}

inline arms::Description frictionless(arms::Description description) {
  description.simulation.coulomb_friction_Nm = {};
  description.simulation.viscous_friction_Nms_per_rad = {};
  return description;
}

}  // namespace inkwell::test
