#include "companion.hpp"

#include <algorithm>
#include <cmath>

#include <GLFW/glfw3.h>

namespace inkwell::window {

namespace {
constexpr float splitter_points = 5.0f;
constexpr float tuning_minimum_points = 300.0f;
constexpr float scope_minimum_points = 150.0f;
constexpr float scene_minimum_points = 240.0f;

// True if a person could see the difference.
bool looks_different(const protocol::PoseReport& a, const protocol::PoseReport& b) {
  constexpr float visible_m = 2e-4f;
  constexpr float visible_N = 0.02f;
  constexpr float visible_rad = 0.02f;
  if (a.state != b.state || a.fault != b.fault || a.switches != b.switches) return true;
  for (int i = 0; i < 3; ++i)
    if (std::abs(a.position_m[i] - b.position_m[i]) > visible_m || std::abs(a.force_N[i] - b.force_N[i]) > visible_N ||
        std::abs(a.gimbal_rad[i] - b.gimbal_rad[i]) > visible_rad)
      return true;
  return false;
}

}  // namespace

Companion::Companion(const WindowOptions& options, const WindowSettings& settings, float scale)
    : options_(options),
      settings_(settings),
      style_{&palette(settings.theme), load_fonts(scale), scale},
      desk_(options.list_devices, options.serial_number),
      tuning_panel_(settings.parameters_file),
      scope_panel_(settings),
      file_is_to_be_sent_(!options.parameters_file.empty()) {
  if (options.virtual_board_control_port != 0) hand_.emplace(options.virtual_board_control_port);
  use_theme(settings.theme);
}

void Companion::use_theme(Theme theme) {
  settings_.theme = theme;
  style_.palette = &palette(theme);
  apply_theme(*style_.palette, style_.scale);
}

WindowSettings Companion::settings() const {
  WindowSettings now = settings_;
  now.parameters_file = tuning_panel_.parameters_file();
  scope_panel_.store(now);
  return now;
}

void Companion::stop() { desk_.session().send(protocol::Command::disable_force); }

void Companion::key(int key, bool down) {
  if (key == GLFW_KEY_SPACE && down) stop();
  if (!hand_ || (down && ImGui::GetIO().WantTextInput)) return;
  if (key == GLFW_KEY_1) button_1_ = down;
  if (key == GLFW_KEY_2) button_2_ = down;
  if (key == GLFW_KEY_1 || key == GLFW_KEY_2) hand_->press_buttons(button_1_, button_2_);
}

void Companion::follow_device(double now_s) {
  const DeviceView& view = desk_.refresh();
  if (!view.connected() || !view.parameters) {
    editor_.disconnected();
    seen_revision_ = 0;
  } else if (view.parameters_revision != seen_revision_) {
    seen_revision_ = view.parameters_revision;
    editor_.device_holds(*view.parameters);
  }
  const std::string refusal = view.refusal.value_or("");
  if (!refusal.empty() && refusal != seen_refusal_) editor_.refused();
  seen_refusal_ = refusal;
  if (file_is_to_be_sent_ && editor_.known()) {
    file_is_to_be_sent_ = false;
    tuning_panel_.load(options_.parameters_file, editor_, now_s);
  }
  editor_.forget_unconfirmed(now_s);
  desk_.select_signals(scope_panel_.signals());
  for (const device::ScopeSamples& samples : desk_.take_scope()) scope_panel_.receive(samples);
}

void Companion::keyboard_shortcuts(double now_s) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!io.KeyCtrl || io.WantTextInput) return;
  if (ImGui::IsKeyPressed(GLFW_KEY_Z)) {
    if (io.KeyShift) {
      editor_.redo(now_s);
    } else {
      editor_.undo(now_s);
    }
  }
  if (ImGui::IsKeyPressed(GLFW_KEY_Y)) editor_.redo(now_s);
}

void Companion::carry_out(const StatusBarOutcome& outcome) {
  if (outcome.stop) stop();
  if (outcome.switch_force_on) desk_.session().send(protocol::Command::enable_force);
  if (outcome.clear_fault) desk_.session().send(protocol::Command::clear_fault);
  if (outcome.toggle_scope) settings_.scope_is_shown = !settings_.scope_is_shown;
  if (outcome.toggle_theme) use_theme(settings_.theme == Theme::dark ? Theme::light : Theme::dark);
}

float Companion::splitter(const char* name, ImVec2 place, ImVec2 size, bool vertical) const {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2{1, 1});
  begin_pane(name, place, size);
  ImGui::InvisibleButton("handle", size);
  const bool lively = ImGui::IsItemHovered() || ImGui::IsItemActive();
  if (lively) ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  ImGui::GetWindowDrawList()->AddRectFilled(place, {place.x + size.x, place.y + size.y},
                                            packed(lively ? style_.palette->accent : style_.palette->ground));
  const ImVec2 moved = ImGui::IsItemActive() ? ImGui::GetIO().MouseDelta : ImVec2{0, 0};
  end_pane();
  ImGui::PopStyleVar(2);
  return (vertical ? moved.x : moved.y) / style_.scale;
}

void Companion::draw(ImVec2 size, double now_s) {
  follow_device(now_s);
  keyboard_shortcuts(now_s);
  const DeviceView& view = desk_.view();
  StatusBarOutcome outcome;

  const float bar = style_.points(status_bar_points);
  const float gap = style_.points(splitter_points);
  const bool fault = view.pose && view.pose->state == protocol::State::fault;
  const float top = bar + (fault ? style_.points(fault_banner_points) : 0.0f);
  const float tuning_width = std::clamp(style_.points(settings_.tuning_width), style_.points(tuning_minimum_points), 0.5f * size.x);
  const float scope_room = size.y - top - style_.points(scene_minimum_points);
  const float scope_height = settings_.scope_is_shown
                                 ? std::max(style_.points(scope_minimum_points), std::min(style_.points(settings_.scope_height), scope_room))
                                 : 0.0f;
  const float left_width = std::floor(size.x - tuning_width - gap);
  const float scene_height = std::floor(size.y - top - (settings_.scope_is_shown ? scope_height + gap : 0.0f));

  outcome = status_bar_.draw({0, 0}, {size.x, bar}, style_, desk_, settings_.scope_is_shown);
  if (fault) outcome.clear_fault = draw_fault_banner({0, bar}, {size.x, top - bar}, style_, view.pose->fault);

  scene_place_ = {0, top};
  scene_size_ = {left_width, scene_height};
  scene_pane_.draw(scene_place_, scene_size_, {style_, view.pose, editor_, hand_ ? &*hand_ : nullptr, now_s});
  if (!view.connected()) draw_connection_card({0.5f * left_width, top + 0.45f * scene_height}, style_, view);

  tuning_panel_.draw({left_width + gap, top}, {size.x - left_width - gap, size.y - top}, style_, editor_, seen_refusal_, now_s);
  settings_.tuning_width -= splitter("tuning splitter", {left_width, top}, {gap, size.y - top}, true);
  settings_.tuning_width = std::clamp(settings_.tuning_width, tuning_minimum_points, 0.5f * size.x / style_.scale);
  if (settings_.scope_is_shown) {
    settings_.scope_height -= splitter("scope splitter", {0, top + scene_height}, {left_width, gap}, false);
    settings_.scope_height = std::clamp(settings_.scope_height, scope_minimum_points, std::max(scope_minimum_points, scope_room / style_.scale));
    scope_panel_.draw({0, top + scene_height + gap}, {left_width, size.y - top - scene_height - gap}, style_);
  }

  const bool scope_runs = settings_.scope_is_shown && view.connected() && !scope_panel_.is_paused();
  is_moving_ = scope_runs || drawn_pose_.has_value() != view.pose.has_value() ||
               (drawn_pose_ && looks_different(*drawn_pose_, *view.pose));
  if (is_moving_) drawn_pose_ = view.pose;

  carry_out(outcome);
  if (auto changes = editor_.take_changes(); !changes.empty()) desk_.session().set_parameters(std::move(changes));
}

void Companion::draw_scene(Renderer& renderer, float pixels_per_unit, int framebuffer_height, bool smooth) const {
  const auto pixels = [pixels_per_unit](float units) { return static_cast<int>(std::lround(units * pixels_per_unit)); };
  const int height = pixels(scene_size_.y);
  scene_pane_.draw_scene(renderer,
                         {pixels(scene_place_.x), framebuffer_height - pixels(scene_place_.y) - height, pixels(scene_size_.x), height},
                         {*style_.palette, options_.flat_colours, smooth && !options_.flat_colours, std::nullopt});
}

}  // namespace inkwell::window
