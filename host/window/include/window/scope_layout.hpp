// What the scope's panes show, and the layouts that come with the window.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <protocol/signals.hpp>

namespace inkwell::window {

enum class PaneKind : std::uint8_t {
  time,      ///< signals against time
  spectrum,  ///< amplitude of the signals against frequency
  xy,        ///< the second signal against the first, the third against the first, ...
};

struct Pane {
  PaneKind kind = PaneKind::time;
  std::string title;
  std::vector<protocol::Signal> signals;
  bool operator==(const Pane&) const = default;
};

struct ScopeLayout {
  std::string name;
  int columns = 2;
  std::vector<Pane> panes;
  bool operator==(const ScopeLayout&) const = default;
};

/// "contact", "paper" (figures 11 to 14), "currents", "interrupt".
std::span<const ScopeLayout> built_in_layouts();
/// The built-in layout of that name, the first one if there is none.
const ScopeLayout& built_in_layout(std::string_view name);

/// Every signal of the layout once, at most as many as the scope can stream; those beyond are left out.
std::vector<protocol::Signal> signals_of(const ScopeLayout& layout);

}  // namespace inkwell::window
