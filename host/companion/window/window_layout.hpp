// Layout of the window. Bars are at the top, scene and scope are on the left, and the pane column is on the right.
#pragma once

#include <imgui.h>

#include "host/companion/window/window_settings.hpp"

namespace inkwell::window {

struct Rectangle {
  ImVec2 origin{0, 0};  ///< top left corner
  ImVec2 size{1, 1};
};

/// All rectangles are in screen coordinates.
struct WindowLayout {
  Rectangle status, scene, replay, scope, column;
  Rectangle column_splitter;  ///< left of the column
  Rectangle scope_splitter;   ///< above the scope
  float room;                 ///< height that scene and scope share
  float scale;

  ImVec2 middle_of_scene() const;
  /// The banner covers the scene below the buttons, so that no other part moves when a banner appears.
  Rectangle banner(float height) const;
};

/// Heights in screen coordinates. Hidden items have the height 0.
struct LayoutNeeds {
  float status_height;
  float replay_height;
};

WindowLayout layout_of(ImVec2 window, const LayoutNeeds& needs, const WindowSettings& settings, float scale);

/// Moves a splitter to the right or down, within the available room. `dragged_points` is the distance.
void drag_column_splitter(float dragged_points, ImVec2 window, float scale, WindowSettings& settings);
void drag_scope_splitter(float dragged_points, const WindowLayout& layout, float scale, WindowSettings& settings);

}  // namespace inkwell::window
