// What the scope is set to, which the window remembers from one time to the next.
#pragma once

#include <scope/scope_layout.hpp>
#include <scope/trigger.hpp>

namespace inkwell::window {

struct ScopeSettings {
  static constexpr double span_minimum_s = 0.001;
  static constexpr double span_maximum_s = 100.0;

  double span_s = 2.0;  ///< time shown
  TriggerSettings trigger;
  ScopeLayout layout = built_in_layout("contact");  ///< as it stands, saved under its name or not
  OwnLayouts own_layouts;
  bool operator==(const ScopeSettings&) const = default;
};

}  // namespace inkwell::window
