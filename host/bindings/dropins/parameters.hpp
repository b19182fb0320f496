// Table of the HDAPI parameters.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "host/bindings/dropins/device.hpp"
#include "host/bindings/dropins/scheduler.hpp"

namespace inkwell::dropins {

/// Bit mask of the permitted parameter types.
enum Type : unsigned {
  type_boolean = 1,
  type_integer = 2,
  type_long = 4,
  type_float = 8,
  type_double = 16,
  type_string = 32
};
inline constexpr unsigned type_real = type_float | type_double;

inline constexpr std::size_t values_maximum = 36;

/// Source of parameter values: a frame of a device, or the scheduler. Both pointers are NULL if there is no device.
struct Source {
  const Device* device;
  const Moment* moment;
  const Scheduler& scheduler;
};

struct Parameter {
  Enum value;
  Enum last;         ///< value code of the same parameter in the previous frame; 0 if there is none
  const char* name;  ///< without HD_; CURRENT_... becomes LAST_... in the previous frame
  const char* unit;
  unsigned count;
  unsigned types;
  const char* meaning;
  /// Writes `count` values. The function is NULL for a text parameter.
  void (*read)(const Source& source, double* values) = nullptr;
  std::string (*text)(const Source& source) = nullptr;
  /// Returns false for a value out of range. The function is NULL for a read-only parameter.
  bool (*write)(Device& device, const double* values) = nullptr;
  bool needs_device = true;
};

std::span<const Parameter> parameter_table();

struct FoundParameter {
  const Parameter* row;
  bool is_last;  ///< the parameter refers to the previous frame
};
std::optional<FoundParameter> find_parameter(Enum value);

}  // namespace inkwell::dropins
