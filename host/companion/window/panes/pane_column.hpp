// The right column with the tabs and the selected pane.
#pragma once

#include <memory>
#include <vector>

#include "host/companion/window/panes/pane.hpp"

namespace inkwell::window {

class PaneColumn {
 public:
  explicit PaneColumn(const PaneSurroundings& around);

  void follow(const PaneNews& news);
  void draw(ImVec2 origin, ImVec2 size, PaneFrame frame);
  void cancel();
  /// Shows the pane of this tab, counted from 0. Returns the pane's name if the caller must set the keyboard focus, and
  /// otherwise an empty text.
  std::string show(std::size_t tab);

  /// Returns the stream of the first pane with a reservation. Without a reservation, returns the signals of the scope,
  /// of the shown pane and of all panes in the background, up to the size limit of the stream.
  PaneStream stream(const std::vector<protocol::Signal>& scope_signals) const;
  bool is_moving() const;
  /// Returns the reason of the first pane that requires the force to stay off; empty if all panes permit the force.
  std::string why_force_waits() const;
  RecordingControls& recording_controls();
  bool scope_is_free(const std::vector<protocol::Signal>& scope_signals) const {
    return stream(scope_signals).feeds_scope;
  }
  /// Starts a guide. Show the pane of the guides, because the guide waits for the user.
  void start_guide(std::string_view name);
  /// Returns the saver of the shown pane; null for a pane without plots.
  PlotSaver* plot_saver() const { return panes_[shown_]->plot_saver(); }
  /// Shows the pane with this title. Returns the pane's name for the keyboard focus.
  std::string show(std::string_view title);

 private:
  /// Returns the height of the tabs.
  float draw_tabs(ImVec2 origin, float width, const Style& style);

  std::vector<std::unique_ptr<Pane>> panes_;
  std::size_t shown_ = 0;
};

}  // namespace inkwell::window
