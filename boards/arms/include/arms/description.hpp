// Arm descriptions: what boards/arms/*.toml say about an arm, checked key by key.
#pragma once

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include <protocol/parameters.hpp>
#include <protocol/plain_text.hpp>

namespace inkwell::arms {

/// What is not a parameter of the three motors, which are alike in it.
struct Motor {
  double inductance_H;
};

/// What only a simulation needs. Links are slender: their inertia is about an axis across the link.
struct Simulation {
  double base_inertia_kg_m2;  ///< all that turns with joint 1 only, about its axis
  double link_2_mass_kg;
  double link_2_centre_m;       ///< centre of mass, from the shoulder
  double link_2_inertia_kg_m2;  ///< about the centre of mass
  double link_3_mass_kg;
  double link_3_centre_m;  ///< centre of mass, from the elbow
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
  /// The arm's rows as the file sets them; the other rows have their defaults.
  protocol::ParameterSet parameters;
  Motor motor;
  Simulation simulation;
};

/// A sentence that names the file, the line where there is one, what is wrong and what to do. It is safe to print.
class DescriptionError : public std::runtime_error {
 public:
  explicit DescriptionError(const std::string& sentence) : std::runtime_error(protocol::plain_lines(sentence)) {}
};

/// Reads an arm description.
/// @throws DescriptionError if the file is missing or not TOML, a key is missing or unknown (a wrong unit
///         included), or a value is no number, out of its range, not whole, or a lower bound not below the upper.
Description read(const std::filesystem::path& file);

/// The same for a text; `source` names it in errors.
Description parse(std::string_view text, const std::string& source);

}  // namespace inkwell::arms
