// Parameter rows from protocol/tables/parameters.toml, and sets of parameter values. The parameters of the image's
// force law follow the last row (docs/force-laws.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <arm/defaults.hpp>
#include "protocol/added_rows.hpp"
#include "protocol/each_axis.hpp"

namespace inkwell::protocol {

enum class ParameterKind : std::uint8_t {
  real,    ///< any value in the range
  whole,   ///< a whole number in the range
  choice,  ///< a whole number; the help text names each value
};

struct ParameterInfo {
  std::uint16_t id;       ///< id in the protocol
  std::string_view name;  ///< ends in its unit
  ParameterKind kind;
  std::string_view unit;  ///< empty for a dimensionless parameter
  float minimum;
  float maximum;
  float default_value;
  std::string_view group;
  const char* help = "";
  bool belongs_to_arm;  ///< true if every arm description sets it
  /// If true, the parameter can change only while the force is off. A change of the arm's geometry would make the force
  /// jump.
  bool needs_force_off;
};

}  // namespace inkwell::protocol

#include <tables/parameters.hpp>  // Parameter, parameter_table

namespace inkwell::protocol {

inline constexpr std::size_t parameter_count = parameter_table.size();

/// Largest number of force law parameters, and the id of the first force law parameter.
inline constexpr std::size_t force_law_parameters_maximum = 12;
inline constexpr std::uint16_t force_law_first_id = 1000;

/// Returns the table rows and the parameters of a known force law.
inline KnownRows<ParameterInfo, parameter_count> known_parameters() { return KnownRows(parameter_table); }

constexpr const ParameterInfo& info(Parameter parameter) {
  const auto index = static_cast<std::size_t>(parameter);
  return index < parameter_count ? parameter_table[index] : known_parameters()[index];
}
constexpr std::size_t row_count(Parameter) { return parameter_count; }
constexpr bool alike(const ParameterInfo& a, const ParameterInfo& b) {
  return a.kind == b.kind && a.unit == b.unit && a.minimum == b.minimum && a.maximum == b.maximum &&
         a.group == b.group && a.belongs_to_arm == b.belongs_to_arm && a.needs_force_off == b.needs_force_off;
}

/// Returns the parameter of motor, joint or axis `axis` (0, 1 or 2). `rows` is the first of the three parameters.
constexpr Parameter of_axis(EachAxis<Parameter> rows, std::size_t axis) { return rows[axis]; }
/// Returns the parameter of motor, joint or axis `number` (1, 2 or 3, as in the row names).
constexpr Parameter of_number(EachAxis<Parameter> rows, int number) {
  return rows[static_cast<std::size_t>(number) - 1];
}

/// Joint stops of the arm. On every arm, the third pair bounds the angle between the links.
inline constexpr EachAxis<Parameter> lower_stops{Parameter::joint_1_minimum_rad, Parameter::joint_2_minimum_rad,
                                                 Parameter::elbow_minimum_rad};
inline constexpr EachAxis<Parameter> upper_stops{Parameter::joint_1_maximum_rad, Parameter::joint_2_maximum_rad,
                                                 Parameter::elbow_maximum_rad};

struct Bounds {
  Parameter lower;
  Parameter upper;
  /// If true, `upper` must exceed `lower` by more than the sphere's diameter. If false, `upper` may exceed `lower` by
  /// any amount.
  bool hold_sphere;
};

/// Every set of parameters must satisfy these conditions, in addition to the range of each parameter.
inline constexpr Bounds parameter_bounds[] = {
    {Parameter::box_minimum_x_m, Parameter::box_maximum_x_m, true},
    {Parameter::box_minimum_y_m, Parameter::box_maximum_y_m, true},
    {Parameter::box_minimum_z_m, Parameter::box_maximum_z_m, true},
    {Parameter::joint_1_minimum_rad, Parameter::joint_1_maximum_rad, false},
    {Parameter::joint_2_minimum_rad, Parameter::joint_2_maximum_rad, false},
    {Parameter::elbow_minimum_rad, Parameter::elbow_maximum_rad, false},
};

/// Values of the table parameters in table order, followed by the parameters of the force law. Unused values are 0.
struct ParameterSet {
  std::array<float, parameter_count + force_law_parameters_maximum> values;

  constexpr float& operator[](Parameter parameter) { return values[static_cast<std::size_t>(parameter)]; }
  constexpr float operator[](Parameter parameter) const { return values[static_cast<std::size_t>(parameter)]; }
  constexpr std::array<float, 3> of_each(EachAxis<Parameter> rows) const {
    return {(*this)[rows[0]], (*this)[rows[1]], (*this)[rows[2]]};
  }
  bool operator==(const ParameterSet&) const = default;
};

/// Returns the defaults of the table, without the parameters of the force law.
constexpr ParameterSet table_defaults() {
  ParameterSet set{};
  for (std::size_t i = 0; i < parameter_count; ++i) set.values[i] = parameter_table[i].default_value;
  return set;
}

/// Returns the defaults of the table and of a known force law.
inline ParameterSet default_parameters() {
  ParameterSet set{};
  const auto rows = known_parameters();
  for (std::size_t i = 0; i < rows.size(); ++i) set.values[i] = rows[i].default_value;
  return set;
}

inline std::optional<Parameter> find_parameter(std::uint16_t id) {
  const auto rows = known_parameters();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].id == id) return static_cast<Parameter>(i);
  return std::nullopt;
}

inline std::optional<Parameter> find_parameter(std::string_view name) {
  const auto rows = known_parameters();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].name == name) return static_cast<Parameter>(i);
  return std::nullopt;
}

static_assert(parameter_table.back().id < force_law_first_id);

}  // namespace inkwell::protocol
