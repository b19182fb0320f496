// Saved settings of the scope.
#pragma once

#include "host/companion/window/scope/scope_layout.hpp"
#include "host/companion/window/scope/trigger.hpp"

namespace inkwell::window {

struct ScopeSettings {
  static constexpr double span_minimum_s = 0.001;
  static constexpr double span_maximum_s = 100.0;

  double span_s = 2.0;  ///< displayed time
  TriggerSettings trigger;
  ScopeLayout layout = built_in_layout("contact");  ///< current layout, including unsaved changes
  OwnLayouts own_layouts;
  bool operator==(const ScopeSettings&) const = default;
};

}  // namespace inkwell::window
