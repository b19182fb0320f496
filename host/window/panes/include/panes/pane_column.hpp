// The right column: its panes, one of them shown, under tabs.
#pragma once

#include <memory>
#include <vector>

#include <panes/pane.hpp>

namespace inkwell::window {

class PaneColumn {
 public:
  explicit PaneColumn(const PaneSurroundings& around);

  void follow(const PaneNews& news);
  void draw(ImVec2 place, ImVec2 size, PaneFrame frame);
  void cancel();
  /// Shows the pane under this tab, counted from 0 on, if there are so many. Returns the part of the window to be given
  /// the keyboard; empty if the pane has taken it.
  std::string show(std::size_t tab);

  /// Of the first pane that takes it; else the scope's signals and then what the shown pane shows, as far as a
  /// selection has room.
  PaneStream stream(const std::vector<protocol::Signal>& scope_signals) const;
  bool is_moving() const;

 private:
  /// Returns their height.
  float draw_tabs(ImVec2 place, float width, const Style& style);

  std::vector<std::unique_ptr<Pane>> panes_;
  std::size_t shown_ = 0;
};

}  // namespace inkwell::window
