// The scope: plots of signals against time, against each other, or as spectra.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <frame/style.hpp>
#include <scope/scope_settings.hpp>
#include <scope/timeline.hpp>

namespace inkwell::window {

class Cursors;
class LayoutMenu;
class SignalList;
class PlotView;
struct PlotArea;
struct ScopeFrame;

class ScopePane {
 public:
  explicit ScopePane(const ScopeSettings& settings);
  ~ScopePane();

  void draw(ImVec2 place, ImVec2 size, const Style& style);
  /// Samples from the device; while paused they are let go, so that what is looked at stays.
  /// `over`: of the same periods, of a recording that is laid over; null if none is.
  void receive(const device::ScopeSamples& samples, const device::ScopeSamples* over = nullptr) {
    timeline_.receive(samples, over);
  }
  /// Forgets what was received: what comes next does not continue it.
  void start_anew() { timeline_.start_anew(); }
  double span_s() const { return timeline_.span_s(); }

  /// What has to be streamed for the plots and the trigger.
  std::vector<protocol::Signal> signals() const;
  /// As they stand now, to be remembered.
  ScopeSettings settings() const;
  /// True if a signal left its range since the last call, rather than only scrolled.
  bool take_motion() { return std::exchange(has_motion_, false); }

 private:
  /// Plots that stay as they are keep their views, with what these remember.
  void follow_layout();
  /// Shift with the arrows moves the picture in time and zooms it, Ctrl with them moves the cursors.
  void take_keys();
  void draw_controls(const Style& style);
  void draw_plots(ScopeFrame& frame);
  /// A signal that is dragged onto the plot joins it.
  void take_dropped_signal(ScopePlot& plot);
  void draw_hint(const ScopePlot& plot, const PlotArea& area, const Style& style) const;
  /// True if the plot is to be removed.
  bool draw_plot(std::size_t index, ImVec2 place, ImVec2 size, ScopeFrame& frame);

  Timeline timeline_;
  ScopeLayout layout_;
  std::vector<std::unique_ptr<PlotView>> views_;  ///< of the layout's plots, in their order
  std::unique_ptr<LayoutMenu> layout_menu_;
  std::unique_ptr<Cursors> cursors_;
  std::unique_ptr<SignalList> signal_list_;
  bool with_statistics_ = false;
  bool has_motion_ = false;
  std::uint64_t judged_end_ = 0;  ///< end of the history in the frame before
};

}  // namespace inkwell::window
