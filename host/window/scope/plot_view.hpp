// A plot of the scope on the screen, with one view class per kind of plot.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include <plot/plot.hpp>
#include <scope/scope_layout.hpp>
#include <scope/timeline.hpp>

#include "cursors.hpp"

namespace inkwell::window {

/// Data that all plots of the scope share in a frame.
struct ScopeFrame {
  const Style& style;
  Timeline& timeline;  ///< the mouse moves its stretch
  Stretch stretch;     ///< displayed stretch
  Cursors& cursors;
  bool with_statistics;
  std::uint64_t judged_end;  ///< end of the history in the previous frame
  bool& has_motion;          ///< set to true if a signal leaves its range; scrolling alone does not count
};

/// Draws a plot and stores its state between frames.
class PlotView {
 public:
  explicit PlotView(ScopePlot plot) : plot_(std::move(plot)) {}
  virtual ~PlotView() = default;
  PlotView(const PlotView&) = delete;
  PlotView& operator=(const PlotView&) = delete;

  const ScopePlot& plot() const { return plot_; }

  /// Height of the numbers above the plot.
  virtual float numbers_height(const ScopeFrame&) const { return 0.0f; }
  /// Draws into the area and determines its axis ranges. ImGui's last item covers the area.
  virtual void draw(PlotArea area, ScopeFrame& frame) = 0;

 protected:
  const ScopePlot plot_;
};

std::unique_ptr<PlotView> view_of(const ScopePlot& plot);

std::unique_ptr<PlotView> time_view(const ScopePlot& plot);
std::unique_ptr<PlotView> spectrum_view(const ScopePlot& plot);
std::unique_ptr<PlotView> xy_view(const ScopePlot& plot);

/// Period for recomputing statistics and spectra, chosen so that the numbers remain readable.
inline constexpr double computed_every_s = 0.2;

}  // namespace inkwell::window
