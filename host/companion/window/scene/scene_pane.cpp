#include "host/companion/window/scene/scene_pane.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/picture_changes.hpp"
#include "host/companion/window/frame/widgets.hpp"

#include "host/companion/window/scene/renderer.hpp"

namespace inkwell::window {

namespace {

constexpr float radians_per_pixel = 0.008f;
constexpr float depth_per_wheel_step_m = 0.004f;
constexpr float probe_grab_points = 22.0f;
constexpr float wall_grab_points = 12.0f;
constexpr float tools_points = 46.0f;  // height of the buttons in the upper left corner
constexpr float sphere_margin_points = 26.0f;
constexpr std::string_view about_the_proxy =
    "A point on the wall surface. A virtual spring connects the proxy to the probe. The force grows with the distance "
    "between proxy and probe, according to the wall stiffness.";
constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};
constexpr std::array<Colour, 3> axis_colours{scene_colours::axis_x, scene_colours::axis_y, scene_colours::axis_z};

glm::vec2 to_glm(ImVec2 vector) { return {vector.x, vector.y}; }

// Returns the rectangle around a text.
Box plate_of(const Style& style, ImVec2 position, const std::string& content) {
  const ImVec2 taken = ImGui::CalcTextSize(content.c_str());
  const float pad = style.points(5);
  return {position.x - pad, position.y - pad * 0.5f, position.x + taken.x + pad, position.y + taken.y + pad * 0.5f};
}

// Draws a label with a background.
void plate(ImDrawList& list, const Style& style, ImVec2 position, Colour colour, const std::string& content) {
  const Box box = plate_of(style, position, content);
  list.AddRectFilled({box.left, box.top}, {box.right, box.bottom}, packed(style.palette->pane.with_alpha(205)),
                     style.points(4));
  list.AddText(position, packed(colour), content.c_str());
}

}  // namespace

ScenePane::ScenePane() : renderer_(std::make_unique<Renderer>()) {}
ScenePane::~ScenePane() = default;

ImVec2 ScenePane::on_screen(glm::vec3 workspace_point_m) const {
  const glm::vec3 pixel = camera_.project(workspace_to_view(scene_.frame) * workspace_point_m, size_);
  return {origin_.x + pixel.x, origin_.y + pixel.y};
}

glm::vec3 ScenePane::wall_handle(int wall) const {
  const WallView& view = scene_.walls[static_cast<std::size_t>(wall)];
  glm::vec3 centre = 0.5f * (scene_.box_minimum_m + scene_.box_maximum_m);
  centre[view.axis] = view.upper ? scene_.box_maximum_m[view.axis] : scene_.box_minimum_m[view.axis];
  return centre;
}

std::optional<int> ScenePane::wall_under(glm::vec2 mouse, float reach) const {
  for (int wall = 0; wall < 6; ++wall)
    if (glm::length(to_glm(on_screen(wall_handle(wall))) - mouse) < reach) return wall;
  return std::nullopt;
}

void ScenePane::start_drag(const ScenePaneInput& input, glm::vec2 mouse) {
  if (!ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    drag_ = Drag::pan;
  } else if (over_probe_) {
    drag_ = Drag::hand;
    grabbed_ = workspace_to_view(scene_.frame) * scene_.probe_m;
  } else if (marked_wall_) {
    drag_ = Drag::wall;
    dragged_wall_ = *marked_wall_;
    const WallView& wall = scene_.walls[static_cast<std::size_t>(dragged_wall_)];
    const Ray ray = camera_.ray(mouse - origin_, size_);
    const glm::mat3 to_view = workspace_to_view(scene_.frame);
    glm::vec3 axis{0.0f};
    axis[wall.axis] = 1.0f;
    wall_grab_offset_m_ = nearest_on_line(ray, to_view * wall_handle(dragged_wall_), to_view * axis);
    input.editor.begin_step("moved wall");
  } else {
    drag_ = Drag::orbit;
  }
}

void ScenePane::continue_drag(const ScenePaneInput& input, glm::vec2 mouse, glm::vec2 moved) {
  const glm::mat3 to_view = workspace_to_view(scene_.frame);
  const Ray ray = camera_.ray(mouse - origin_, size_);
  switch (drag_) {
    case Drag::none: break;
    case Drag::orbit: camera_.orbit(-moved.x * radians_per_pixel, moved.y * radians_per_pixel); break;
    case Drag::pan: camera_.pan(moved, size_.y); break;
    case Drag::hand: {
      grabbed_ += camera_.direction() * (ImGui::GetIO().MouseWheel * depth_per_wheel_step_m);
      grabbed_ = on_view_plane(camera_, ray, grabbed_);
      input.hand->pull_to(within_reach(scene_.probe_m, glm::transpose(to_view) * grabbed_));
      break;
    }
    case Drag::wall: {
      const WallView& wall = scene_.walls[static_cast<std::size_t>(dragged_wall_)];
      const glm::vec3 handle = wall_handle(dragged_wall_);
      glm::vec3 axis{0.0f};
      axis[wall.axis] = 1.0f;
      const float along_m = nearest_on_line(ray, to_view * handle, to_view * axis) - wall_grab_offset_m_;
      const float wall_m = dragged_wall_m(input.editor.shown(), wall.axis, wall.upper, handle[wall.axis] + along_m);
      const device::ParameterChange change{wall_parameter(wall.axis, wall.upper), wall_m};
      input.editor.edit({&change, 1}, input.now_s);
      break;
    }
  }
}

void ScenePane::end_drag(const ScenePaneInput& input) {
  // After a drag, the hand holds the probe at the proxy position.
  if (drag_ == Drag::hand) input.hand->pull_to(scene_.proxy_m);
  if (drag_ == Drag::wall) input.editor.end_step();
  drag_ = Drag::none;
}

void ScenePane::handle_mouse(const ScenePaneInput& input) {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 mouse = to_glm(io.MousePos);
  ImGui::SetCursorScreenPos({origin_.x, origin_.y});
  allow_overlap_before_item();
  ImGui::InvisibleButton(
      "scene", {size_.x, size_.y},
      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
  allow_overlap_after_item();
  note_item("scene");
  const bool hovered = ImGui::IsItemHovered();
  if (drag_ == Drag::none) {
    const float reach = input.style.points(probe_grab_points);
    over_probe_ = hovered && input.hand != nullptr && glm::length(to_glm(on_screen(scene_.probe_m)) - mouse) < reach;
    marked_wall_ = hovered && !over_probe_ && input.editor.known()
                       ? wall_under(mouse, input.style.points(wall_grab_points))
                       : std::nullopt;
    if (ImGui::IsItemActivated() && !is_pressed_by_keyboard()) start_drag(input, mouse);
  }
  if (drag_ != Drag::none) {
    continue_drag(input, mouse, to_glm(io.MouseDelta));
    if (!ImGui::IsItemActive()) end_drag(input);
  } else if (hovered && io.MouseWheel != 0.0f) {
    camera_.zoom(io.MouseWheel);
  }
  if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && !over_probe_ && !marked_wall_) reset_view();
  if (over_probe_ || marked_wall_ || drag_ == Drag::hand || drag_ == Drag::wall)
    ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
}

void ScenePane::handle_keys(const ScenePaneInput& input) {
  constexpr float turn_rad = 0.08f, pan_pixels = 24.0f, hand_step_m = 0.002f;
  const auto number = [](int steps) { return static_cast<float>(steps); };
  const KeySteps turn = key_steps_in_part(with_shift);
  if (turn.any()) {
    camera_.orbit(turn_rad * number(turn.right), turn_rad * number(turn.up));
    camera_.zoom(number(turn.away));
  }
  const KeySteps pan = key_steps_in_part(with_shift | with_ctrl);
  if (pan.any())
    camera_.pan({input.style.points(pan_pixels) * number(pan.right), -input.style.points(pan_pixels) * number(pan.up)},
                size_.y);
  const KeySteps hand = key_steps_in_part(with_ctrl);
  if (!hand.any() || input.hand == nullptr || drag_ != Drag::none) return;
  const glm::vec3 from_m = input.hand->target_m().value_or(scene_.probe_m);
  const glm::vec3 ahead = camera_.direction();
  const glm::vec3 right = glm::normalize(glm::cross(ahead, glm::vec3{0.0f, 1.0f, 0.0f}));
  const glm::vec3 step =
      number(hand.right) * right + number(hand.up) * glm::cross(right, ahead) + number(hand.away) * ahead;
  input.hand->pull_to(
      within_reach(scene_.probe_m, from_m + glm::transpose(workspace_to_view(scene_.frame)) * (hand_step_m * step)));
}

void ScenePane::draw_axes(ImDrawList& list, const Style& style) const {
  const glm::vec2 centre = origin_ + glm::vec2{style.points(46), size_.y - style.points(46)};
  const glm::mat3 to_eye = glm::mat3(camera_.view()) * workspace_to_view(scene_.frame);
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, {}, [&](int axis) { return to_eye[axis].z; });  // the nearest axis is drawn last
  for (int axis : order) {
    const glm::vec2 tip = centre + style.points(26) * glm::vec2{to_eye[axis].x, -to_eye[axis].y};
    const glm::vec2 label = centre + style.points(37) * glm::vec2{to_eye[axis].x, -to_eye[axis].y};
    const Colour colour = axis_colours[static_cast<std::size_t>(axis)];
    list.AddLine({centre.x, centre.y}, {tip.x, tip.y}, packed(colour), style.points(2));
    list.AddCircleFilled({tip.x, tip.y}, style.points(2.6f), packed(colour));
    const char* name = axis_names[static_cast<std::size_t>(axis)];
    const ImVec2 taken = ImGui::CalcTextSize(name);
    list.AddText({label.x - 0.5f * taken.x, label.y - 0.5f * taken.y}, packed(style.palette->text), name);
  }
}

// Records the positions of the sphere and of the wall handles for inspections.
void ScenePane::note_handles() const {
  const auto note_point = [](std::string_view name, ImVec2 point) { note_area(name, point, point); };
  note_area("view", {origin_.x, origin_.y}, {origin_.x + size_.x, origin_.y + size_.y});
  note_point("sphere", on_screen(scene_.probe_m));
  for (const WallView& wall : scene_.walls)
    note_point(protocol::info(wall_parameter(wall.axis, wall.upper)).name,
               on_screen(wall_handle(2 * wall.axis + (wall.upper ? 1 : 0))));
}

// Draws the label and the tooltip of the proxy.
void ScenePane::draw_proxy_label(ImDrawList& list, const Style& style) const {
  const glm::vec2 proxy = to_glm(on_screen(scene_.proxy_m));
  const float radius =
      scene_.sphere_radius_m / camera_.metres_per_pixel(workspace_to_view(scene_.frame) * scene_.proxy_m, size_.y);
  constexpr std::string_view name = "proxy";
  const ImVec2 taken = ImGui::CalcTextSize(name.data());
  const ImVec2 corner{proxy.x - 0.5f * taken.x, proxy.y + radius + style.points(7)};
  const ImVec2 end{corner.x + taken.x, corner.y + taken.y};
  plate(list, style, corner, style.palette->text_quiet, std::string(name));
  note_area(name, corner, end);
  const float around = style.points(6);
  if (drag_ == Drag::none &&
      ImGui::IsMouseHoveringRect({corner.x - around, corner.y - around}, {end.x + around, end.y + around}, false))
    help_on_hover("Proxy", about_the_proxy, style);
}

// Draws the handles of the walls. The label shows the position of the marked wall.
void ScenePane::draw_wall_handles(ImDrawList& list, const Style& style) const {
  const Palette& palette = *style.palette;
  for (int wall = 0; wall < 6; ++wall) {
    const bool marked = marked_wall_ == wall || (drag_ == Drag::wall && dragged_wall_ == wall);
    const ImVec2 handle = on_screen(wall_handle(wall));
    list.AddCircleFilled(handle, style.points(marked ? 5.5f : 3.5f), packed(palette.pane));
    list.AddCircle(handle, style.points(marked ? 5.5f : 3.5f), packed(marked ? palette.accent : palette.text_quiet), 0,
                   style.points(1.5f));
    if (!marked) continue;
    const WallView& view = scene_.walls[static_cast<std::size_t>(wall)];
    plate(list, style, {handle.x + style.points(12), handle.y - style.points(8)}, palette.text,
          fmt::format("{} {} {:.0f} mm", axis_names[static_cast<std::size_t>(view.axis)],
                      view.upper ? "maximum" : "minimum", 1000.0f * wall_handle(wall)[view.axis]));
  }
}

// Draws the force value at the tip of the force arrow. Returns the rectangle of the label.
Box ScenePane::draw_force_label(ImDrawList& list, const Style& style) const {
  const float force_N = glm::length(scene_.force_N);
  if (force_N <= 0.02f) return {};
  const ImVec2 tip = on_screen(force_arrow_tip_m(scene_));
  const std::string label = fmt::format("{:.2f} N", force_N);
  // The label must not cover the arrow.
  const bool to_the_left = tip.x < on_screen(scene_.probe_m).x;
  const float left =
      to_the_left ? tip.x - ImGui::CalcTextSize(label.c_str()).x - style.points(10) : tip.x + style.points(10);
  const ImVec2 corner{left, tip.y - style.points(8)};
  plate(list, style, corner, style.palette->text, label);
  return plate_of(style, corner, label);
}

// Draws the force value of the simulated hand. The two force labels do not overlap.
void ScenePane::draw_hand_label(ImDrawList& list, const Style& style, const Box& force_plate) const {
  if (!hand_view_) return;
  const float pull_N = static_cast<float>(hand_stiffness_N_per_m) * glm::length(hand_view_->target_m - scene_.probe_m);
  if (pull_N <= 0.25f) return;
  // The label must not cover the sphere.
  const ImVec2 target = on_screen(hand_view_->target_m);
  const std::string label = fmt::format("hand {:.1f} N", pull_N);
  const bool to_the_left = target.x < on_screen(scene_.probe_m).x;
  const float left =
      to_the_left ? target.x - ImGui::CalcTextSize(label.c_str()).x - style.points(16) : target.x + style.points(16);
  ImVec2 corner{left, target.y - style.points(22)};
  if (const Box box = plate_of(style, corner, label); !common(box, force_plate).is_empty())
    corner.y -= box.bottom - force_plate.top + style.points(2);
  plate(list, style, corner, style.palette->text_quiet, label);
}

// The points are in front of all objects, because the sphere would cover the points.
void ScenePane::draw_contact_points(ImDrawList& list, const ScenePaneInput& input) const {
  const Style& style = input.style;
  for (const glm::vec3 point_m : input.objects.contact_points_m()) {
    if (camera_.project(workspace_to_view(scene_.frame) * point_m, size_).z <= 0.0f) continue;
    const ImVec2 point = on_screen(point_m);
    list.AddCircleFilled(point, style.points(4.5f), packed(style.palette->pane));
    list.AddCircleFilled(point, style.points(3.0f), packed(scene_colours::wall_touched));
    note_area("contact point", point, point);
  }
}

// Draws the progress text at the upper right, or below the buttons in a narrow pane.
void ScenePane::draw_progress(ImDrawList& list, const ScenePaneInput& input) const {
  const std::string progress = input.objects.progress();
  if (progress.empty()) return;
  const Style& style = input.style;
  constexpr float buttons_points = 340.0f;
  const float left = size_.x - ImGui::CalcTextSize(progress.c_str()).x - style.points(16);
  const ImVec2 corner = left > style.points(buttons_points)
                            ? ImVec2{origin_.x + left, origin_.y + style.points(16)}
                            : ImVec2{origin_.x + style.points(18), origin_.y + style.points(tools_points)};
  plate(list, style, corner, style.palette->text, progress);
  note_text(progress);
}

// Draws the probe position at the lower right. A wide pane also shows a help text.
void ScenePane::draw_footer(ImDrawList& list, const ScenePaneInput& input) const {
  const Style& style = input.style;
  float room_x = origin_.x + size_.x - style.points(16);
  if (input.pose && input.pose->is_referenced) {
    const std::string position = fmt::format("x {:+6.1f}   y {:+6.1f}   z {:+6.1f} mm", 1000.0f * scene_.probe_m.x,
                                             1000.0f * scene_.probe_m.y, 1000.0f * scene_.probe_m.z);
    const ImVec2 taken = ImGui::CalcTextSize(position.c_str());
    room_x -= taken.x;
    plate(list, style, {room_x, origin_.y + size_.y - taken.y - style.points(12)}, style.palette->text, position);
    room_x -= style.points(22);
  }
  const char* help =
      input.hand == nullptr
          ? "Drag to turn, right drag to move, wheel to zoom"
          : "Drag the sphere to move the hand (wheel: depth), drag elsewhere to turn, right drag to move";
  const float help_x = origin_.x + style.points(88);
  if (help_x + ImGui::CalcTextSize(help).x < room_x)
    plate(list, style, {help_x, origin_.y + size_.y - style.points(27)}, style.palette->text_quiet, help);
}

void ScenePane::draw_labels(const ScenePaneInput& input) const {
  const Style& style = input.style;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImGui::PushFont(style.fonts.caption);
  draw_axes(list, style);
  if (ImGui::IsItemHovered() || drag_ != Drag::none) draw_wall_handles(list, style);
  if (over_probe_ || drag_ == Drag::hand) {
    const ImVec2 probe = on_screen(scene_.probe_m);
    list.AddCircle(probe, style.points(15), packed(scene_colours::probe.with_alpha(190)), 0, style.points(1.5f));
  }
  draw_contact_points(list, input);
  draw_progress(list, input);
  const Box force_plate = draw_force_label(list, style);
  if (scene_.in_contact) draw_proxy_label(list, style);
  draw_hand_label(list, style, force_plate);
  draw_footer(list, input);
  ImGui::PopFont();
}

void ScenePane::draw_tools(const ScenePaneInput& input) {
  const Style& style = input.style;
  ImGui::SetCursorScreenPos({origin_.x + style.points(14), origin_.y + style.points(12)});
  if (button("Reset view")) reset_view();
  help_on_hover("", "Shows the whole box and all objects, like a double click in the scene.", style);
  if (input.hand == nullptr) return;
  ImGui::SameLine();
  ImGui::BeginDisabled(!input.hand->target_m());
  if (button("Release stylus")) input.hand->let_go();
  ImGui::EndDisabled();
  help_on_hover("", "The simulated hand releases the stylus, and gravity moves the arm.", style);
  ImGui::SameLine();
  ImGui::BeginDisabled(input.hand->is_docked());
  if (button("Return to inkwell")) input.hand->put_into_inkwell();
  ImGui::EndDisabled();
  help_on_hover("", "The simulated hand puts the stylus into the inkwell, and the board references the encoders.",
                style);
  if (const std::string error = input.hand->error(); !error.empty()) {
    ImGui::SetCursorScreenPos({origin_.x + style.points(14), ImGui::GetCursorScreenPos().y});
    text(style.palette->caution, error);
  }
}

glm::vec2 ScenePane::card_corner(glm::vec2 card, const ScenePaneInput& input) {
  const Style& style = input.style;
  const float margin = style.points(12), footer = style.points(40), tools = style.points(tools_points);
  const float top = tools + input.covered_height;
  const std::array<glm::vec2, 4> corners{{{0.5f * (size_.x - card.x), size_.y - card.y - footer},
                                          {size_.x - card.x - margin, top},
                                          {margin, top},
                                          {0.5f * (size_.x - card.x), size_.y - card.y - style.points(4)}}};
  const auto is_free = [&](glm::vec2 corner) {
    const float around = style.points(sphere_margin_points);
    const glm::vec2 sphere = to_glm(on_screen(scene_.probe_m)) - origin_;
    return sphere.x < corner.x - around || sphere.x > corner.x + card.x + around || sphere.y < corner.y - around ||
           sphere.y > corner.y + card.y + around;
  };
  const glm::vec2 mouse = to_glm(ImGui::GetIO().MousePos);
  const bool is_used = ImGui::IsAnyMouseDown() || (mouse.x >= card_.left && mouse.x <= card_.right &&
                                                   mouse.y >= card_.top && mouse.y <= card_.bottom);
  if (!is_used) {
    const auto better = std::ranges::find_if(corners, is_free);
    if (better != corners.end()) card_position_ = static_cast<std::size_t>(better - corners.begin());
  }
  return origin_ + corners[card_position_];
}

bool ScenePane::draw_next_step(const ScenePaneInput& input) {
  if (!input.next_step) {
    card_ = {};
    card_position_ = 0;
    return false;
  }
  const NextStep& step = *input.next_step;
  const Style& style = input.style;
  const Palette& palette = *style.palette;
  const float pad = style.points(12), gap = style.points(14), button_width = style.points(126);
  const float room = std::min(style.points(430), size_.x - button_width - gap - 2 * pad - style.points(24));
  const auto taken_by = [room](ImFont* font, const std::string& content) {
    return content.empty() ? ImVec2{0, 0} : font->CalcTextSizeA(font->FontSize, 1e4f, room, content.c_str());
  };
  const ImVec2 title = taken_by(style.fonts.strong, step.title), reason = taken_by(style.fonts.caption, step.reason);
  const float line_gap = step.reason.empty() ? 0.0f : style.points(3);
  const float text_height = title.y + line_gap + reason.y, button_height = ImGui::GetFrameHeight();
  const float height = std::max(text_height, button_height) + style.points(16);
  const float text_width = std::max(title.x, reason.x) + 1.0f;
  const glm::vec2 card{text_width + gap + button_width + 2 * pad, height};
  const glm::vec2 corner = card_corner(card, input);
  card_ = {corner.x, corner.y, corner.x + card.x, corner.y + card.y};

  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({card_.left, card_.top}, {card_.right, card_.bottom}, packed(palette.pane.with_alpha(240)),
                     style.points(8));
  list.AddRect({card_.left, card_.top}, {card_.right, card_.bottom},
               packed(scene_.in_contact ? palette.accent : palette.outline), style.points(8), 0,
               style.points(scene_.in_contact ? 2.0f : 1.0f));
  note_area("next step", {card_.left, card_.top}, {card_.right, card_.bottom});
  const float left = corner.x + pad, top = corner.y + 0.5f * (height - text_height);
  const auto line = [&](ImFont* font, Colour colour, const std::string& content, float y) {
    if (content.empty()) return;
    list.AddText(font, font->FontSize, {left, y}, packed(colour), content.c_str(), nullptr, room);
    note_text(content);
  };
  line(style.fonts.strong, palette.text, step.title, top);
  line(style.fonts.caption, palette.text_quiet, step.reason, top + title.y + line_gap);
  ImGui::SetCursorScreenPos({left + text_width + gap, corner.y + 0.5f * (height - button_height)});
  return primary_button(step.button.c_str(), style, {button_width, 0});
}

void ScenePane::draw_replay_border(const Style& style) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 colour = packed(style.palette->caution);
  const float line = style.points(3);
  list.PushClipRectFullScreen();
  list.AddRect({origin_.x + 0.5f * line, origin_.y + 0.5f * line},
               {origin_.x + size_.x - 0.5f * line, origin_.y + size_.y - 0.5f * line}, colour, 0, 0, line);
  constexpr std::string_view label = "REPLAY: a recording, not the arm";
  ImGui::PushFont(style.fonts.strong);
  const ImVec2 taken = ImGui::CalcTextSize(label.data());
  const ImVec2 pad{style.points(12), style.points(6)};
  const ImVec2 corner{origin_.x + 0.5f * (size_.x - taken.x) - pad.x, origin_.y};
  list.AddRectFilled(corner, {corner.x + taken.x + 2 * pad.x, corner.y + taken.y + 2 * pad.y}, colour, style.points(6),
                     ImDrawFlags_RoundCornersBottom);
  list.PopClipRect();
  ImGui::SetCursorScreenPos({corner.x + pad.x, corner.y + pad.y});
  text(style.palette->on_caution, label);
  ImGui::PopFont();
}

void ScenePane::fit_view(const SceneObjects& objects) {
  glm::vec3 minimum_m = scene_.box_minimum_m, maximum_m = scene_.box_maximum_m;
  if (const auto box = objects.box()) {
    minimum_m = glm::min(minimum_m, box->minimum_m);
    maximum_m = glm::max(maximum_m, box->maximum_m);
  }
  const glm::mat3 to_view = workspace_to_view(scene_.frame);
  const glm::vec3 a = to_view * minimum_m, b = to_view * maximum_m;
  camera_ = fitted_camera_ = look_at_box(glm::min(a, b), glm::max(a, b));
  fitted_meshes_ = objects.meshes_revision();
  view_is_to_be_reset_ = false;
}

bool ScenePane::draw(ImVec2 origin, ImVec2 size, const ScenePaneInput& input) {
  origin_ = to_glm(origin);
  size_ = glm::max(to_glm(size), glm::vec2{1.0f});
  scene_ = build_scene(input.pose, input.editor.shown());
  const auto target_m = input.hand == nullptr ? std::nullopt : input.hand->target_m();
  hand_view_ = target_m ? std::optional(HandView{*target_m, drag_ == Drag::hand}) : std::nullopt;
  objects_ = input.objects.objects();
  // New objects do not change a view that the user has chosen.
  const bool has_new_meshes = input.objects.meshes_revision() != fitted_meshes_ && camera_ == fitted_camera_;
  if (view_is_to_be_reset_ || has_new_meshes) fit_view(input.objects);
  begin_pane("scene", origin, size, ImGuiWindowFlags_NoScrollWithMouse);
  handle_mouse(input);
  handle_keys(input);
  note_handles();
  draw_labels(input);
  draw_tools(input);
  const bool is_next_step_taken = draw_next_step(input);
  if (input.is_replay) draw_replay_border(input.style);
  end_pane();
  return is_next_step_taken;
}

void ScenePane::add_to(PictureDigest& digest) const {
  static_assert(sizeof camera_ == 6 * sizeof(float));
  digest.add_bytes(&camera_, sizeof camera_);
  if (hand_view_) {
    digest.add_bytes(&hand_view_->target_m, sizeof hand_view_->target_m);
    digest.add(hand_view_->held);
  }
  digest.add(drag_ == Drag::wall ? dragged_wall_ : marked_wall_.value_or(-1));
}

void ScenePane::draw_scene(const Viewport& viewport, SceneLook look) const {
  look.marked_wall = drag_ == Drag::wall ? std::optional(dragged_wall_) : marked_wall_;
  renderer_->draw(scene_, objects_, hand_view_, camera_, look, viewport);
}

}  // namespace inkwell::window
