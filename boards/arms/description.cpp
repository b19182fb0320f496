#include "boards/arms/description.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <span>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "boards/arms/known_keys.hpp"

namespace inkwell::arms {
namespace {

struct Number {
  std::string_view name;
  double* value;
  double minimum;
  double maximum;
};

/// Reads one section of the file. Each error names the file and the line.
class Section {
 public:
  Section(const toml::table& file, std::string_view name, const std::string& source) : name_(name), source_(source) {
    const auto* node = file.get(name);
    if (node == nullptr)
      throw DescriptionError(fmt::format("{}: the section [{}] is missing; see omni.toml.", source, name));
    table_ = node->as_table();
    if (table_ == nullptr) fail(*node, fmt::format("{} must be a section: [{}]", name, name));
  }

  void refuse_unknown(std::span<const std::string_view> known) const {
    for (const auto& [key, node] : *table_) {
      const std::string_view word = key.str();
      if (std::ranges::find(known, word) == known.end())
        fail(node, fmt::format("[{}] has no key {}: {}", name_, word, advice_for(word, known)));
    }
  }

  std::string text(std::string_view key) const {
    const auto& node = get(key);
    const auto* value = node.as_string();
    if (value == nullptr) fail(node, fmt::format("{} must be a text in quotes", key));
    return value->get();
  }

  double number(std::string_view key, double minimum, double maximum) const {
    const auto& node = get(key);
    // Booleans and strings are not accepted as numbers, although the TOML library could convert them.
    if (!node.is_number()) fail(node, fmt::format("{} must be a number", key));
    const double value = *node.value<double>();
    if (!std::isfinite(value)) fail(node, fmt::format("{} must be a finite number", key));
    if (value < minimum || value > maximum)
      fail(node,
           fmt::format("{} = {} is out of range; give a number from {:.6g} to {:.6g}", key, value, minimum, maximum));
    return value;
  }

  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    const bool ends = what.ends_with('?');
    throw DescriptionError(fmt::format("{}, line {}: {}{}", source_, node.source().begin.line, what, ends ? "" : "."));
  }

  const toml::node& get(std::string_view key) const {
    const auto* node = table_->get(key);
    if (node == nullptr)
      throw DescriptionError(
          fmt::format("{}: {} is missing in section [{}]; omni.toml shows every key.", source_, key, name_));
    return *node;
  }

 private:
  std::string name_;
  const std::string& source_;
  const toml::table* table_ = nullptr;
};

void read_numbers(const Section& section, std::span<const Number> numbers) {
  std::vector<std::string_view> known;
  for (const auto& row : numbers) known.push_back(row.name);
  section.refuse_unknown(known);
  for (const auto& row : numbers) *row.value = section.number(row.name, row.minimum, row.maximum);
}

protocol::ParameterSet read_parameters(const Section& section) {
  std::vector<std::string_view> known;
  for (const auto& row : protocol::parameter_table)
    if (row.belongs_to_arm) known.push_back(row.name);
  section.refuse_unknown(known);

  auto set = protocol::default_parameters();
  for (std::size_t i = 0; i < protocol::parameter_count; ++i) {
    const auto& row = protocol::parameter_table[i];
    if (!row.belongs_to_arm) continue;
    const double value = section.number(row.name, static_cast<double>(row.minimum), static_cast<double>(row.maximum));
    if (row.kind != protocol::ParameterKind::real && value != std::floor(value))
      section.fail(section.get(row.name), fmt::format("{} = {} must be a whole number", row.name, value));
    set.values[i] = static_cast<float>(value);
  }

  for (const auto& [lower, upper, hold_sphere] : protocol::parameter_bounds)
    if (!(set[lower] < set[upper]))
      section.fail(section.get(info(lower).name),
                   fmt::format("{} must be below {}", info(lower).name, info(upper).name));
  return set;
}

Motor read_motor(const Section& section) {
  Motor motor{};
  const Number numbers[] = {{"inductance_H", &motor.inductance_H, 1e-6, 1}};
  read_numbers(section, numbers);
  return motor;
}

Simulation read_simulation(const Section& section) {
  Simulation s{};
  const Number numbers[] = {
      {"base_inertia_kg_m2", &s.base_inertia_kg_m2, 1e-9, 10},
      {"link_2_mass_kg", &s.link_2_mass_kg, 0, 100},
      {"link_2_centre_m", &s.link_2_centre_m, -1, 1},
      {"link_2_inertia_kg_m2", &s.link_2_inertia_kg_m2, 1e-9, 10},
      {"link_3_mass_kg", &s.link_3_mass_kg, 0, 100},
      {"link_3_centre_m", &s.link_3_centre_m, -1, 1},
      {"link_3_inertia_kg_m2", &s.link_3_inertia_kg_m2, 1e-9, 10},
      {"probe_mass_kg", &s.probe_mass_kg, 0, 10},
      {"rotor_inertia_kg_m2", &s.rotor_inertia_kg_m2, 0, 1},
      {"coulomb_friction_1_Nm", &s.coulomb_friction_Nm[0], 0, 10},
      {"coulomb_friction_2_Nm", &s.coulomb_friction_Nm[1], 0, 10},
      {"coulomb_friction_3_Nm", &s.coulomb_friction_Nm[2], 0, 10},
      {"viscous_friction_1_Nms_per_rad", &s.viscous_friction_Nms_per_rad[0], 0, 10},
      {"viscous_friction_2_Nms_per_rad", &s.viscous_friction_Nms_per_rad[1], 0, 10},
      {"viscous_friction_3_Nms_per_rad", &s.viscous_friction_Nms_per_rad[2], 0, 10},
      {"stop_stiffness_Nm_per_rad", &s.stop_stiffness_Nm_per_rad, 0.1, 1000},
      {"stop_damping_Nms_per_rad", &s.stop_damping_Nms_per_rad, 0, 10},
      {"gravity_m_per_s2", &s.gravity_m_per_s2, 0, 100},
  };
  read_numbers(section, numbers);
  return s;
}

}  // namespace

Description parse(std::string_view text, const std::string& source) {
  toml::table file;
  try {
    file = toml::parse(text, source);
  } catch (const toml::parse_error& error) {
    throw DescriptionError(
        fmt::format("{}, line {}: this is not TOML: {}.", source, error.source().begin.line, error.description()));
  }

  constexpr std::string_view sections[] = {"arm", "parameters", "motor", "simulation"};
  for (const auto& [key, node] : file)
    if (std::ranges::find(sections, key.str()) == std::end(sections))
      throw DescriptionError(fmt::format("{}, line {}: there is no section or key {} at the top of the file: {}{}",
                                         source, node.source().begin.line, key.str(), advice_for(key.str(), sections),
                                         advice_for(key.str(), sections).ends_with('?') ? "" : "."));

  const Section arm(file, "arm", source);
  constexpr std::string_view arm_keys[] = {"name", "description"};
  arm.refuse_unknown(arm_keys);
  return Description{
      .name = protocol::plain_text(arm.text("name")),
      .description = protocol::plain_lines(arm.text("description")),
      .parameters = read_parameters(Section(file, "parameters", source)),
      .motor = read_motor(Section(file, "motor", source)),
      .simulation = read_simulation(Section(file, "simulation", source)),
  };
}

Description read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    throw DescriptionError(fmt::format(
        "{}: this arm description cannot be read. Check the path; examples are in boards/arms of the sources and in "
        "share/inkwell/arms of an installation.",
        file.string()));
  std::stringstream text;
  text << stream.rdbuf();
  return parse(text.str(), file.string());
}

}  // namespace inkwell::arms
