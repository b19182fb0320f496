// Layouts of the scope with their plots and signals.
#pragma once

// To add a layout, add a row to built_in_layouts() in host/companion/window/scope/scope_layout.cpp.
//
// To add a kind of plot:
// (1) Add a value to PlotKind and update plot_kind_count.
// (2) Write a PlotView class in a new file. An example is host/companion/window/scope/time_view.cpp. Add the file to
//     CMakeLists.txt. Add the view to plot_view.hpp and to view_of() in plot_view.cpp.
// (3) Add the names to host/companion/window/scope/plot_menu.cpp and host/companion/window/window_settings.cpp.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/companion/window/scope/scope_signal.hpp"
#include "host/companion/window/scope/signal_history.hpp"
#include "protocol/signals.hpp"

namespace inkwell::window {

enum class PlotKind : std::uint8_t {
  time,      ///< signals over time
  spectrum,  ///< amplitude of the signals over frequency
  xy,        ///< all other signals over the first signal
};
inline constexpr std::size_t plot_kind_count = static_cast<std::size_t>(PlotKind::xy) + 1;  // xy is the last kind

/// Fixed range of the y axis, in the unit of the signals.
struct FixedRange {
  double minimum;
  double maximum;
  bool operator==(const FixedRange&) const = default;
};

struct ScopePlot {
  PlotKind kind = PlotKind::time;
  std::string title;
  std::vector<ScopeSignal> signals;
  std::optional<FixedRange> fixed_range = {};  ///< empty: the range follows the signals
  bool operator==(const ScopePlot&) const = default;
};

struct ScopeLayout {
  std::string name;
  int columns = 2;
  std::vector<ScopePlot> plots;
  std::vector<Formula> formulas = {};  ///< all formulas of the layout, including formulas without a plot
  bool operator==(const ScopeLayout&) const = default;
};

/// Returns the layouts "contact", "paper" (figures 11 to 14), "wall" (force over penetration), "currents", "overview"
/// (eight plots) and "interrupt".
std::span<const ScopeLayout> built_in_layouts();
/// Returns the built-in layout with this name, or the first built-in layout if no layout has this name.
const ScopeLayout& built_in_layout(std::string_view name);

/// Layouts saved by the user.
class OwnLayouts {
 public:
  OwnLayouts() = default;
  explicit OwnLayouts(std::vector<ScopeLayout> layouts);  ///< layouts with an invalid name are omitted

  std::span<const ScopeLayout> all() const { return layouts_; }
  const ScopeLayout* find(std::string_view name) const;

  /// Returns the reason why the name is invalid for a layout, or an empty text. A saved layout replaces the user layout
  /// with the same name.
  static std::string refusal(std::string_view name);
  void save(ScopeLayout layout);
  /// Renames the layout. Returns an error message; empty on success.
  std::string rename(std::string_view from, std::string_view to);
  void remove(std::string_view name);

  bool operator==(const OwnLayouts&) const = default;

 private:
  std::vector<ScopeLayout> layouts_;
};

/// Returns the user layout or built-in layout with this name, or null.
const ScopeLayout* find_layout(std::string_view name, const OwnLayouts& own);
/// Returns all layout names, separated by commas.
std::string layout_names(const OwnLayouts& own);
/// Returns the layout with this name, or the first built-in layout if the name is unknown.
const ScopeLayout& layout_named(std::string_view name, const OwnLayouts& own);

/// Finds a device signal or a formula by name.
std::optional<ScopeSignal> find_scope_signal(std::string_view name, std::span<const Formula> formulas);
/// Replaces the formula named `before` in the layout and in all plots. If no formula has this name, adds the new
/// formula.
void put_formula(ScopeLayout& layout, const Formula& formula, std::string_view before);
/// Removes the formula from the layout and from all plots. Removes plots without signals.
void remove_formula(ScopeLayout& layout, std::string_view name);
/// Returns the formulas that the plots show, without repetitions.
std::vector<ScopeSignal> shown_formulas(const ScopeLayout& layout);

/// Returns advice for a plot without data; empty if the plot shows data.
std::string hint_for(const ScopePlot& plot, const SignalHistory& history);

/// Returns each signal of the layout once, up to the size limit of the stream.
std::vector<protocol::Signal> signals_of(const ScopeLayout& layout);

}  // namespace inkwell::window
