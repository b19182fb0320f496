// The scope shows time plots, xy plots and spectra of signals.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/companion/window/frame/picture_changes.hpp"
#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/plot/plot_axis.hpp"
#include "host/companion/window/scope/scope_settings.hpp"
#include "host/companion/window/scope/timeline.hpp"

namespace inkwell::window {

class Cursors;
class LayoutMenu;
class SignalList;
class PlotView;
class PlotSaver;
enum class PlotMenuChoice : std::uint8_t;
struct PlotArea;
struct PlotFrame;

class ScopePane {
 public:
  explicit ScopePane(const ScopeSettings& settings);
  ~ScopePane();

  void draw(ImVec2 origin, ImVec2 size, const Style& style, bool is_replay);
  /// Adds samples from the device or a recording. `over` contains the samples of the overlaid recording, or is null.
  void receive(const device::ScopeSamples& samples, const device::ScopeSamples* over = nullptr) {
    timeline_.receive(samples, over);
  }
  /// Replaces the history by other signals of the same time.
  void refill(const std::vector<ReceivedBlock>& blocks) { timeline_.refill(blocks); }
  const SignalHistory& history() const { return timeline_.history(); }
  /// Clears the history. Call if the next samples do not directly follow the previous samples.
  void restart() { timeline_.restart(); }
  void toggle_pause() { timeline_.pause(!timeline_.is_paused()); }
  /// Freezes the plots shortly after this control period.
  void freeze_at_fault(std::int64_t period) { timeline_.freeze_at(period); }
  /// Shows the signals around the last fault.
  void show_fault() { timeline_.show_fault(); }
  /// Resumes the plots if a fault has frozen them.
  void resume_after_fault() {
    if (timeline_.is_frozen_at_fault()) timeline_.pause(false);
  }
  PlotSaver& saver() { return *saver_; }
  const PlotSaver& saver() const { return *saver_; }
  /// Returns the drawn y range of each plot by its title, for inspections.
  std::vector<std::pair<std::string, AxisRange>> drawn_ranges() const;
  double span_s() const { return timeline_.span_s(); }

  /// Returns the signals that the plots and the trigger need.
  std::vector<protocol::Signal> signals() const;
  /// Returns the current scope settings.
  ScopeSettings settings() const;
  /// Returns true if a signal exceeded its previous range since the last call.
  bool take_motion() { return std::exchange(has_motion_, false); }

 private:
  /// Creates the views of new plots. Unchanged plots retain their views.
  void follow_layout();
  /// The arrow keys move and zoom the time range with Shift, and move the cursors with Ctrl.
  void take_keys();
  void draw_controls(const Style& style, bool is_replay);
  void draw_plots(PlotFrame& frame);
  /// Adds a signal that the user drops onto the plot.
  void take_dropped_signal(ScopePlot& plot);
  void draw_hint(const ScopePlot& plot, const PlotArea& area, const Style& style) const;
  /// Carries out an action of the plot's menu, except its removal.
  void carry_out(PlotMenuChoice choice, std::size_t index, const PlotFrame& frame);
  /// Returns true if the user removes the plot.
  bool draw_plot(std::size_t index, ImVec2 origin, ImVec2 size, PlotFrame& frame);

  Timeline timeline_;
  ScopeLayout layout_;
  std::vector<std::unique_ptr<PlotView>> views_;  ///< views of the layout's plots, in the same order
  std::unique_ptr<LayoutMenu> layout_menu_;
  std::unique_ptr<Cursors> cursors_;
  std::unique_ptr<SignalList> signal_list_;
  bool with_statistics_ = false;
  std::unique_ptr<PlotSaver> saver_;
  bool has_motion_ = false;
  std::uint64_t judged_end_ = 0;  ///< end of the history in the previous frame
};

}  // namespace inkwell::window
