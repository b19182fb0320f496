// Where everything lies in the window: bars on top, scene over scope at the left, the column of panes at the right.
#pragma once

#include <imgui.h>

#include <window/window_settings.hpp>

namespace inkwell::window {

struct Rectangle {
  ImVec2 place{0, 0};  ///< top left
  ImVec2 size{1, 1};
};

/// In screen coordinates.
struct WindowLayout {
  Rectangle status, banner, scene, replay, scope, column;
  Rectangle column_splitter;  ///< left of the column
  Rectangle scope_splitter;   ///< above the scope
  float room;                 ///< height that scene and scope share

  ImVec2 middle_of_scene() const;
};

/// What the layout has to make room for. Heights in screen coordinates, 0 for what is not shown.
struct LayoutNeeds {
  float status_height;
  float banner_height;
  float banner_room;  ///< what lies below it begins so far under the status bar; else the banner lies over it
  float replay_height;
};

WindowLayout layout_of(ImVec2 window, const LayoutNeeds& needs, const WindowSettings& settings, float scale);

/// Takes up a drag of a splitter to the right or down, in points, within what the window has room for.
void drag_column_splitter(float dragged_points, ImVec2 window, float scale, WindowSettings& settings);
void drag_scope_splitter(float dragged_points, const WindowLayout& layout, float scale, WindowSettings& settings);

}  // namespace inkwell::window
