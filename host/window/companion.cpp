#include "companion.hpp"

#include <algorithm>
#include <cmath>

#include <GLFW/glfw3.h>
#include <nlohmann/json.hpp>

#include <frame/inspection.hpp>

namespace inkwell::window {

namespace {
constexpr float splitter_points = 5.0f;
constexpr float tabs_points = 40.0f;
constexpr float tuning_minimum_points = 300.0f;
constexpr float scope_minimum_points = 150.0f;
constexpr float scene_minimum_points = 240.0f;

}  // namespace

Companion::Companion(const WindowOptions& options, const WindowSettings& settings, float scale)
    : options_(options),
      settings_(settings),
      style_{&palette(settings.theme), load_fonts(scale), scale},
      desk_(options.list_devices, options.serial_number),
      tuning_pane_(settings.parameters_file),
      scope_pane_(settings.scope),
      guides_pane_(desk_, options.virtual_board_control_port, options.simulated_arm),
      file_is_to_be_sent_(!options.parameters_file.empty()) {
  if (options.virtual_board_control_port != 0) hand_.emplace(options.virtual_board_control_port);
  use_theme(settings.theme);
  if (!options.recording.empty()) {
    replay_bar_.open(options.recording);
    tab_ = Tab::recording;
  }
}

void Companion::use_theme(Theme theme) {
  settings_.theme = theme;
  style_.palette = &palette(theme);
  apply_theme(*style_.palette, style_.scale);
}

WindowSettings Companion::settings() const {
  WindowSettings now = settings_;
  now.parameters_file = tuning_pane_.parameters_file();
  now.scope = scope_pane_.settings();
  return now;
}

nlohmann::json Companion::inspect(const std::optional<protocol::PoseReport>& arrived) const {
  const DeviceView& view = desk_.view();
  nlohmann::json known{{"connected", view.connected()}, {"state", protocol::info(view.state()).name}};
  if (view.pose) known["pose_at_periods"] = view.pose->time_periods;
  if (arrived) known["arrived_at_periods"] = arrived->time_periods;
  if (view.status.applied_at_periods) known["applied_at_periods"] = *view.status.applied_at_periods;
  return known;
}

std::optional<double> Companion::pose_age_s() {
  const auto newest = newest_arrived();
  if (!newest || !desk_.view().pose || replay_bar_.is_open()) return std::nullopt;
  return static_cast<double>(newest->time_periods - desk_.view().pose->time_periods) / protocol::servo_rate_Hz;
}

void Companion::stop() {
  guides_pane_.cancel();
  desk_.session().send(protocol::Command::disable_force);
}

void Companion::key(int key, bool down) {
  if (key == GLFW_KEY_SPACE && down) stop();
  if (!hand_ || (down && ImGui::GetIO().WantTextInput)) return;
  if (key == GLFW_KEY_1) button_1_ = down;
  if (key == GLFW_KEY_2) button_2_ = down;
  if (key == GLFW_KEY_1 || key == GLFW_KEY_2) hand_->press_buttons(button_1_, button_2_);
}

void Companion::follow_device(double now_s) {
  if (desk_.has_choice()) {
    guides_pane_.cancel();  // while its device is still there to take back what was on trial
    desk_.follow_choice();
  }
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
    tuning_pane_.load(options_.parameters_file, editor_, now_s);
  }
  editor_.forget_unconfirmed(now_s);
  const auto frames = desk_.take_scope();
  guides_pane_.follow(frames);
  const bool guide_has_scope = !guides_pane_.signals().empty();
  recording_pane_.follow(view, frames);
  desk_.select_signals(guide_has_scope                  ? guides_pane_.signals()
                       : recording_pane_.is_recording() ? recording_pane_.signals()
                                                        : scope_pane_.signals());
  if (!guide_has_scope && !replay_bar_.is_open())
    for (const device::ScopeSamples& samples : frames) scope_pane_.receive(samples);
}

void Companion::follow_replay(double now_s) {
  try {
    if (const auto file = recording_pane_.take_replay_wish()) replay_bar_.open(*file);
  } catch (const device::Error& error) {
    recording_pane_.refuse_replay(error.what());
  }
  replay_bar_.follow(now_s, scope_pane_);
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
  note_item("handle");
  const bool lively = ImGui::IsItemHovered() || ImGui::IsItemActive();
  if (lively) ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  ImGui::GetWindowDrawList()->AddRectFilled(place, {place.x + size.x, place.y + size.y},
                                            packed(lively ? style_.palette->accent : style_.palette->ground));
  const ImVec2 moved = ImGui::IsItemActive() ? ImGui::GetIO().MouseDelta : ImVec2{0, 0};
  end_pane();
  ImGui::PopStyleVar(2);
  return (vertical ? moved.x : moved.y) / style_.scale;
}

float Companion::draw_tabs(ImVec2 place, float width) {
  const float height = style_.points(tabs_points);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{style_.points(12), style_.points(6)});
  begin_pane("tabs", place, {width, height}, ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  const float third = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3.0f;
  const auto button = [&](const char* label, Tab tab) {
    if (toggle_button(label, tab_ == tab, style_, {third, 0})) tab_ = tab;
  };
  button("Tuning##tab", Tab::tuning);
  ImGui::SameLine();
  button("Guides##tab", Tab::guides);
  ImGui::SameLine();
  button("Recording##tab", Tab::recording);
  end_pane();
  return height;
}

void Companion::draw(ImVec2 size, double now_s) {
  follow_device(now_s);
  follow_replay(now_s);
  keyboard_shortcuts(now_s);
  const DeviceView& view = desk_.view();
  StatusBarOutcome outcome;

  const float bar = status_bar_.height(size.x, style_);
  const float gap = style_.points(splitter_points);
  const std::optional<Banner> banner = banner_of(view);
  const float top = bar + (banner ? banner_height(size.x, style_, *banner) : 0.0f);
  const float tuning_width =
      std::min(style_.points(std::max(settings_.tuning_width, tuning_minimum_points)), 0.5f * size.x);
  const float scope_room = size.y - top - style_.points(scene_minimum_points);
  const float scope_height =
      settings_.scope_is_shown
          ? std::max(style_.points(scope_minimum_points), std::min(style_.points(settings_.scope_height), scope_room))
          : 0.0f;
  const float left_width = std::floor(size.x - tuning_width - gap);
  const bool replays = replay_bar_.is_open();
  const float replay_height = replays ? style_.points(replay_bar_points) : 0.0f;
  const float scene_end = std::floor(size.y - (settings_.scope_is_shown ? scope_height + gap : 0.0f));
  const float scene_height = scene_end - top - replay_height;

  outcome = status_bar_.draw({0, 0}, {size.x, bar}, style_, desk_, settings_.scope_is_shown);
  if (banner) outcome.clear_fault = draw_banner({0, bar}, {size.x, top - bar}, style_, *banner);

  scene_place_ = {0, top};
  scene_size_ = {left_width, scene_height};
  const std::optional<protocol::PoseReport> pose = replays ? replay_bar_.pose() : view.pose;
  ParameterEditor& editor = replays ? replay_bar_.editor() : editor_;
  scene_pane_.draw(scene_place_, scene_size_, {style_, pose, editor, hand_ && !replays ? &*hand_ : nullptr, now_s});
  if (replays) replay_bar_.draw({0, scene_end - replay_height}, {left_width, replay_height}, style_, scope_pane_);
  if (!view.connected() && !replays)
    draw_connection_card({0.5f * left_width, top + 0.45f * scene_height}, style_, view);

  const ImVec2 column{left_width + gap, top};
  const float column_width = size.x - left_width - gap;
  const float tabs = draw_tabs(column, column_width);
  const ImVec2 pane_place{column.x, column.y + tabs}, pane_size{column_width, size.y - top - tabs};
  switch (tab_) {
    case Tab::tuning:
      tuning_pane_.draw(pane_place, pane_size, style_, editor,
                        replays ? "These parameters are the recording's. Close it to tune the device." : seen_refusal_,
                        now_s);
      break;
    case Tab::guides: guides_pane_.draw(pane_place, pane_size, style_); break;
    case Tab::recording:
      recording_pane_.draw(pane_place, pane_size, style_, view, guides_pane_.signals().empty(), scope_pane_.signals());
      break;
  }
  settings_.tuning_width -= splitter("tuning splitter", {left_width, top}, {gap, size.y - top}, true);
  settings_.tuning_width =
      std::max(tuning_minimum_points, std::min(settings_.tuning_width, 0.5f * size.x / style_.scale));
  if (settings_.scope_is_shown) {
    settings_.scope_height -= splitter("scope splitter", {0, scene_end}, {left_width, gap}, false);
    settings_.scope_height = std::clamp(settings_.scope_height, scope_minimum_points,
                                        std::max(scope_minimum_points, scope_room / style_.scale));
    scope_pane_.draw({0, scene_end + gap}, {left_width, size.y - scene_end - gap}, style_);
  }

  const bool scene_moves = looks_different(drawn_pose_, pose);
  is_moving_ = scene_moves || guides_pane_.is_running() || replay_bar_.is_playing() ||
               (settings_.scope_is_shown && scope_pane_.take_motion());
  if (scene_moves) drawn_pose_ = pose;

  carry_out(outcome);
  if (auto changes = editor_.take_changes(); !changes.empty()) desk_.session().set_parameters(std::move(changes));
}

bool Companion::device_moves() const {
  return guides_pane_.is_running() || (!replay_bar_.is_open() && looks_different(drawn_pose_, desk_.newest_pose()));
}

std::uint64_t Companion::scene_digest() const {
  PictureDigest digest;
  if (drawn_pose_) digest.add_bytes(&*drawn_pose_, sizeof *drawn_pose_);
  const auto parameters = (replay_bar_.is_open() ? replay_bar_.editor() : editor_).shown();
  digest.add_bytes(parameters.values.data(), parameters.values.size() * sizeof parameters.values[0]);
  digest.add(style_.palette);
  for (const float each : {scene_place_.x, scene_place_.y, scene_size_.x, scene_size_.y}) digest.add(each);
  scene_pane_.add_to(digest);
  return digest.value();
}

void Companion::draw_scene(float pixels_per_unit, int framebuffer_height, bool smooth, bool is_as_before) const {
  const auto pixels = [pixels_per_unit](float units) { return static_cast<int>(std::lround(units * pixels_per_unit)); };
  const int height = pixels(scene_size_.y);
  scene_pane_.draw_scene(
      {pixels(scene_place_.x), framebuffer_height - pixels(scene_place_.y) - height, pixels(scene_size_.x), height},
      {*style_.palette, options_.flat_colours, smooth && !options_.flat_colours, is_as_before, std::nullopt});
}

}  // namespace inkwell::window
