#include "host/companion/window/window_layout.hpp"

#include <algorithm>
#include <cmath>

namespace inkwell::window {

namespace {

constexpr float splitter_points = 5.0f;
constexpr float banner_margin_points = 12.0f;
constexpr float scene_buttons_points = 46.0f;
constexpr float scene_minimum_points = 240.0f;
constexpr float column_part_maximum = 0.5f;  // of the window's width

/// Returns the height of the scope in screen coordinates. `room` is the common height of scene and scope.
float scope_height_of(float room, const WindowSettings& settings, float scale) {
  const float minimum = WindowSettings::scope_height_minimum * scale;
  return std::floor(
      std::clamp(settings.scope_part * room, minimum, std::max(minimum, room - scene_minimum_points * scale)));
}

}  // namespace

ImVec2 WindowLayout::middle_of_scene() const {
  return {scene.origin.x + 0.5f * scene.size.x, scene.origin.y + 0.45f * scene.size.y};
}

Rectangle WindowLayout::banner(float height) const {
  const float margin = banner_margin_points * scale;
  return {{scene.origin.x + margin, scene.origin.y + scene_buttons_points * scale},
          {scene.size.x - 2 * margin, height}};
}

WindowLayout layout_of(ImVec2 window, const LayoutNeeds& needs, const WindowSettings& settings, float scale) {
  const float gap = splitter_points * scale;
  const float top = needs.status_height;
  const float room = window.y - top;
  const float column_width = std::min(std::max(settings.column_width, WindowSettings::column_width_minimum) * scale,
                                      column_part_maximum * window.x);
  const float left_width = std::floor(window.x - column_width - gap);
  const float scope_height = scope_height_of(room, settings, scale);
  const float scene_end = std::floor(window.y - (settings.scope_is_shown ? scope_height + gap : 0.0f));

  WindowLayout layout{};
  layout.status = {{0, 0}, {window.x, needs.status_height}};
  layout.scene = {{0, top}, {left_width, scene_end - top - needs.replay_height}};
  layout.replay = {{0, scene_end - needs.replay_height}, {left_width, needs.replay_height}};
  layout.scope_splitter = {{0, scene_end}, {left_width, gap}};
  layout.scope = {{0, scene_end + gap}, {left_width, window.y - scene_end - gap}};
  layout.column_splitter = {{left_width, top}, {gap, room}};
  layout.column = {{left_width + gap, top}, {window.x - left_width - gap, room}};
  layout.room = room;
  layout.scale = scale;
  return layout;
}

void drag_column_splitter(float dragged_points, ImVec2 window, float scale, WindowSettings& settings) {
  if (dragged_points == 0.0f) return;  // a temporarily small window does not change the saved column width
  settings.column_width =
      std::max(WindowSettings::column_width_minimum,
               std::min(settings.column_width - dragged_points, column_part_maximum * window.x / scale));
}

void drag_scope_splitter(float dragged_points, const WindowLayout& layout, float scale, WindowSettings& settings) {
  if (dragged_points == 0.0f) return;
  // The drag starts at the displayed height, which may differ from the saved height.
  const float shown = scope_height_of(layout.room, settings, scale);
  settings.scope_part = std::clamp((shown - dragged_points * scale) / layout.room, WindowSettings::scope_part_minimum,
                                   WindowSettings::scope_part_maximum);
}

}  // namespace inkwell::window
