// What the scope's plots show, and the layouts that come with the window.
#pragma once

// To add a layout, add a row to built_in_layouts() in host/window/scope/scope_layout.cpp.
//
// To add a kind of plot:
// 1. Add a value to PlotKind and update plot_kind_count.
// 2. Write a PlotView in a file like host/window/scope/time_view.cpp. Add the file to CMakeLists.txt and the view
//    to plot_view.hpp and to view_of() in plot_view.cpp.
// 3. Add the names to host/window/scope/plot_menu.cpp and host/window/window_settings.cpp.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <protocol/signals.hpp>
#include <scope/scope_signal.hpp>
#include <scope/signal_history.hpp>

namespace inkwell::window {

enum class PlotKind : std::uint8_t {
  time,      ///< signals against time
  spectrum,  ///< amplitude of the signals against frequency
  xy,        ///< the second signal against the first, the third against the first, ...
};
inline constexpr std::size_t plot_kind_count = static_cast<std::size_t>(PlotKind::xy) + 1;  // the last one

struct ScopePlot {
  PlotKind kind = PlotKind::time;
  std::string title;
  std::vector<ScopeSignal> signals;
  bool operator==(const ScopePlot&) const = default;
};

struct ScopeLayout {
  std::string name;
  int columns = 2;
  std::vector<ScopePlot> plots;
  std::vector<Formula> formulas = {};  ///< that plots may show, whether one does or not
  bool operator==(const ScopeLayout&) const = default;
};

/// "contact", "paper" (figures 11 to 14), "wall" (force against penetration), "currents", "overview"
/// (eight plots), "interrupt".
std::span<const ScopeLayout> built_in_layouts();
/// The built-in layout of that name, the first one if there is none.
const ScopeLayout& built_in_layout(std::string_view name);

/// The layouts that the user has named and saved. Those that come with the window keep their names and contents.
class OwnLayouts {
 public:
  OwnLayouts() = default;
  explicit OwnLayouts(std::vector<ScopeLayout> layouts);  ///< those whose name is refused are left out

  std::span<const ScopeLayout> all() const { return layouts_; }
  const ScopeLayout* find(std::string_view name) const;

  /// Why no layout may be saved under this name; empty if one may. A layout of one's own is replaced.
  static std::string refusal(std::string_view name);
  void save(ScopeLayout layout);
  /// Why `from` cannot be called `to`; empty once it is.
  std::string rename(std::string_view from, std::string_view to);
  void remove(std::string_view name);

  bool operator==(const OwnLayouts&) const = default;

 private:
  std::vector<ScopeLayout> layouts_;
};

/// The layout of that name, one's own or built in; null if there is none.
const ScopeLayout* find_layout(std::string_view name, const OwnLayouts& own);
/// The names of all, with commas between them.
std::string layout_names(const OwnLayouts& own);
/// The layout of that name, one's own or built in; the first of the built-in ones if there is none.
const ScopeLayout& layout_named(std::string_view name, const OwnLayouts& own);

/// The signal of that name: the device's, or what one of the formulas gives.
std::optional<ScopeSignal> find_scope_signal(std::string_view name, std::span<const Formula> formulas);
/// Takes the place of the layout's formula of the name `before`, in its plots as well; joins them if there is none.
void put_formula(ScopeLayout& layout, const Formula& formula, std::string_view before);
/// Takes it out of the plots, too; a plot that has nothing left goes.
void remove_formula(ScopeLayout& layout, std::string_view name);
/// The formulas that the plots show, each once.
std::vector<ScopeSignal> shown_formulas(const ScopeLayout& layout);

/// What to do so that the plot shows something; empty if it does.
std::string hint_for(const ScopePlot& plot, const SignalHistory& history);

/// Every signal of the layout once, at most as many as the scope can stream; those beyond are left out.
std::vector<protocol::Signal> signals_of(const ScopeLayout& layout);

}  // namespace inkwell::window
