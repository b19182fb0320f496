// Views of the plots in the scope. Each plot type has a view class.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "host/companion/window/plot/plot.hpp"
#include "host/companion/window/plot/plot_export.hpp"
#include "host/companion/window/scope/scope_layout.hpp"
#include "host/companion/window/scope/timeline.hpp"

#include "host/companion/window/scope/cursors.hpp"

namespace inkwell::window {

/// Data of one frame for all plots.
struct PlotFrame {
  const Style& style;
  Timeline& timeline;  ///< the mouse moves its displayed section
  Stretch stretch;     ///< displayed section
  Cursors& cursors;
  bool with_statistics;
  std::uint64_t judged_end;  ///< end of the history in the previous frame
  bool& has_motion;          ///< set to true if a signal leaves its range, but not for scrolling
};

/// View of a plot. The view retains its state between frames.
class PlotView {
 public:
  explicit PlotView(ScopePlot plot) : plot_(std::move(plot)) {}
  virtual ~PlotView() = default;
  PlotView(const PlotView&) = delete;
  PlotView& operator=(const PlotView&) = delete;

  const ScopePlot& plot() const { return plot_; }
  /// Returns the y range of the last frame.
  AxisRange drawn_y() const { return drawn_y_; }

  /// Returns the height of the statistics above the plot.
  virtual float numbers_height(const PlotFrame&) const { return 0.0f; }
  /// Draws the plot into the area and determines the axis ranges. The last ImGui item must cover the area.
  virtual void draw(PlotArea area, PlotFrame& frame) = 0;
  /// Returns the displayed values for files.
  virtual PlotTable table(const PlotFrame& frame) const;

 protected:
  /// Replaces the measured range by the fixed range of the plot, if any.
  AxisRange shown_range(AxisRange measured) const {
    return plot_.fixed_range ? AxisRange{plot_.fixed_range->minimum, plot_.fixed_range->maximum} : measured;
  }

  const ScopePlot plot_;
  AxisRange drawn_x_{0, 1}, drawn_y_{0, 1};  ///< in the last frame
};

std::unique_ptr<PlotView> view_of(const ScopePlot& plot);

std::unique_ptr<PlotView> time_view(const ScopePlot& plot);
std::unique_ptr<PlotView> spectrum_view(const ScopePlot& plot);
std::unique_ptr<PlotView> xy_view(const ScopePlot& plot);

/// Update period of the displayed statistics and spectra.
inline constexpr double computed_every_s = 0.2;

}  // namespace inkwell::window
