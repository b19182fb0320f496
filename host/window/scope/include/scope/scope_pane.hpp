// The scope: panes of signals against time, against each other, or as spectra.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <frame/style.hpp>
#include <plot/plot.hpp>
#include <plot/plot_axis.hpp>
#include <scope/analysis.hpp>
#include <scope/scope_settings.hpp>
#include <scope/signal_history.hpp>
#include <scope/trigger.hpp>

namespace inkwell::window {

class ScopePane {
 public:
  explicit ScopePane(const ScopeSettings& settings);

  void draw(ImVec2 place, ImVec2 size, const Style& style);
  /// Samples from the device; while paused they are let go, so that what is looked at stays.
  void receive(const device::ScopeSamples& samples);
  /// What has to be streamed for the panes and the trigger.
  std::vector<protocol::Signal> signals() const;
  ScopeSettings settings() const;
  bool is_paused() const { return paused_; }
  double span_s() const { return span_s_; }
  /// True if a signal left its range since the last call, rather than only scrolled.
  bool take_motion() { return std::exchange(has_motion_, false); }
  /// Forgets what was received: what comes next does not continue it.
  void start_anew();

 private:
  /// The stretch of the history that all time panes show, in samples; `zero` is where their axis says 0.
  struct Stretch {
    double first;
    double last;
    double zero;
    double span() const { return last - first; }
  };
  /// What a pane remembers from frame to frame.
  struct PaneMemory {
    SteadyRange y;
    SteadyRange x;
    std::vector<Statistics> statistics;
    std::vector<Spectrum> spectra;
    double computed_at_s = -1.0;
  };

  Stretch stretch();
  void pause(bool paused);
  void choose_layout(const ScopeLayout& layout);

  void judge_motion(const Pane& pane, const PlotArea& area);
  void draw_toolbar(const Style& style);
  void draw_trigger_tools(const Style& style);
  void draw_layout_menu(const Style& style);
  void draw_layout_name(const Style& style);
  void draw_panes(const Stretch& shown, const Style& style);
  void draw_pane(std::size_t index, ImVec2 place, ImVec2 size, const Stretch& stretch, const Style& style);
  void draw_pane_menu(std::size_t index, const Style& style);
  void draw_legend(std::size_t index, ImVec2 place, float width, const Stretch& stretch, const Style& style) const;
  void draw_time(std::size_t index, PlotArea area, const Stretch& stretch, const Style& style);
  void draw_spectrum(std::size_t index, PlotArea area, const Stretch& stretch, const Style& style);
  float statistics_height(const Pane& pane, const Style& style) const;
  void draw_xy(std::size_t index, PlotArea area, const Stretch& stretch, const Style& style);
  void draw_cursors(const PlotArea& area, const Style& style);
  void handle_mouse(const PlotArea& area, const Stretch& stretch);

  SignalHistory history_;
  Trigger trigger_;
  TriggerSettings trigger_settings_;
  ScopeLayout layout_;
  OwnLayouts own_layouts_;
  enum class NameTask : std::uint8_t { none, save, rename } name_task_ = NameTask::none;
  std::string name_;  // that is typed for a layout
  std::string name_refusal_;
  std::vector<PaneMemory> memory_;
  double span_s_;
  bool paused_ = false;
  bool has_motion_ = false;
  std::uint64_t judged_end_ = 0;  // end of the history in the frame before
  double paused_last_ = 0.0;      // right end of the picture while paused
  bool cursors_are_shown_ = false;
  std::array<double, 2> cursors_{-0.66, -0.33};  // in parts of the span, from the right end
  int dragged_cursor_ = -1;
  bool statistics_are_shown_ = false;
  std::optional<std::size_t> removed_pane_;
};

}  // namespace inkwell::window
