// Reads and validates the arm descriptions in boards/arms/*.toml.
#pragma once

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "protocol/parameters.hpp"
#include "protocol/plain_text.hpp"

namespace inkwell::arms {

/// Motor properties that are not parameters. The three motors are identical.
struct Motor {
  double inductance_H;
};

/// Properties that only a simulation needs. Each link inertia refers to an axis perpendicular to the link.
struct Simulation {
  double base_inertia_kg_m2;  ///< inertia about the axis of joint 1, without the links
  double link_2_mass_kg;
  double link_2_centre_m;       ///< center of mass, from the shoulder
  double link_2_inertia_kg_m2;  ///< about the center of mass
  double link_3_mass_kg;
  double link_3_centre_m;  ///< center of mass, from the elbow
  double link_3_inertia_kg_m2;
  double probe_mass_kg;
  double rotor_inertia_kg_m2;                 ///< of each motor, before the gear
  std::array<double, 3> coulomb_friction_Nm;  ///< at the joint
  std::array<double, 3> viscous_friction_Nms_per_rad;
  double stop_stiffness_Nm_per_rad;
  double stop_damping_Nms_per_rad;
  double gravity_m_per_s2;
};

struct Description {
  std::string name;
  std::string description;
  /// Parameters that the file does not set have their default values.
  protocol::ParameterSet parameters;
  Motor motor;
  Simulation simulation;
};

/// The message states file, line, error and remedy.
class DescriptionError : public std::runtime_error {
 public:
  explicit DescriptionError(const std::string& sentence) : std::runtime_error(protocol::plain_lines(sentence)) {}
};

/// Reads an arm description.
/// @throws DescriptionError if the file is missing, is not TOML, has a missing or unknown key, or has an invalid value.
Description read(const std::filesystem::path& file);

/// Reads an arm description from a string. Error messages use `source` as the name of the string.
Description parse(std::string_view text, const std::string& source);

}  // namespace inkwell::arms
