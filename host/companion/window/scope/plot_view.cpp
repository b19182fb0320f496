#include "host/companion/window/scope/plot_view.hpp"

namespace inkwell::window {

std::unique_ptr<PlotView> view_of(const ScopePlot& plot) {
  switch (plot.kind) {
    case PlotKind::time: return time_view(plot);
    case PlotKind::spectrum: return spectrum_view(plot);
    case PlotKind::xy: return xy_view(plot);
  }
  return time_view(plot);
}

}  // namespace inkwell::window
