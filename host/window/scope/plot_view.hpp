// A plot of the scope on the screen: one kind of view for each kind of plot.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include <plot/plot.hpp>
#include <scope/scope_layout.hpp>
#include <scope/timeline.hpp>

#include "cursors.hpp"

namespace inkwell::window {

/// What all plots of the scope have in common in a frame.
struct ScopeFrame {
  const Style& style;
  Timeline& timeline;  ///< the mouse moves it
  Stretch stretch;     ///< that is shown
  Cursors& cursors;
  bool with_statistics;
  std::uint64_t judged_end;  ///< end of the history in the frame before
  bool& has_motion;          ///< becomes true if a signal leaves its range, rather than only scrolls
};

/// Draws a plot, and remembers what it needs from frame to frame.
class PlotView {
 public:
  explicit PlotView(ScopePlot plot) : plot_(std::move(plot)) {}
  virtual ~PlotView() = default;
  PlotView(const PlotView&) = delete;
  PlotView& operator=(const PlotView&) = delete;

  const ScopePlot& plot() const { return plot_; }

  /// Height of the numbers that stand above the plot.
  virtual float numbers_height(const ScopeFrame&) const { return 0.0f; }
  /// Fills the area, whose ranges it finds itself. The last item of ImGui's lies over it.
  virtual void draw(PlotArea area, ScopeFrame& frame) = 0;

 protected:
  const ScopePlot plot_;
};

/// The view of a plot, by its kind.
std::unique_ptr<PlotView> view_of(const ScopePlot& plot);

std::unique_ptr<PlotView> time_view(const ScopePlot& plot);
std::unique_ptr<PlotView> spectrum_view(const ScopePlot& plot);
std::unique_ptr<PlotView> xy_view(const ScopePlot& plot);

/// Statistics and spectra are computed anew after so long, at which numbers can still be read.
inline constexpr double computed_every_s = 0.2;

}  // namespace inkwell::window
