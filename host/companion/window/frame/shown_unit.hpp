// Units of displayed values. Files, commands and the protocol use meters. The window shows millimeters.
#pragma once

#include <string_view>

namespace inkwell::window {

/// A displayed value is the value times `factor`, in the unit `name`.
struct ShownUnit {
  std::string_view name;
  float factor = 1.0f;
};

constexpr ShownUnit shown_unit(std::string_view unit) {
  if (unit == "m") return {"mm", 1000.0f};
  return {unit};
}

}  // namespace inkwell::window
