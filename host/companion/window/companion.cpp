#include "host/companion/window/companion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <GLFW/glfw3.h>
#include <nlohmann/json.hpp>

#include "host/companion/window/bars/connection_card.hpp"
#include "host/companion/window/bars/return_card.hpp"
#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/picture_digest.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/plot/plot_saver.hpp"

namespace inkwell::window {

Companion::Companion(const WindowOptions& options, const WindowSettings& settings, float scale, std::string problem)
    : flat_colours_(options.flat_colours),
      may_start_virtual_board_(options.start_virtual_board != nullptr),
      problem_(std::move(problem)),
      settings_(settings),
      fonts_(scale),
      style_{&palette(settings.theme), fonts_.fonts(), scale},
      desk_(options.list_devices, options.serial_number, options.on_pose),
      updater_(options.firmware, options.board),
      objects_(options.shown_objects, options.contact_points_m, options.object_loading),
      scope_pane_(settings.scope),
      column_({.desk = desk_,
               .parameters_file = settings_.parameters_file,
               .parameters_to_send = options.parameters_file,
               .control = options.virtual_board_control,
               .simulated_arm = options.simulated_arm,
               .replay = [this](const std::filesystem::path& recording) { replay_bar_.open(recording); },
               .starts_with_replay = !options.replay.recording.empty(),
               .replayed = [this] { return replay_bar_.recording(); },
               .seek = [this](double position_s) { replay_bar_.seek(position_s); }}) {
  if (options.virtual_board_control) hand_.emplace(*options.virtual_board_control);
  use_theme(settings.theme);
  if (!options.replay.recording.empty()) replay_bar_.open(options.replay.recording);
  if (!options.replay.over.empty()) replay_bar_.lay_over(options.replay.over, options.replay.align);
}

WindowSettings Companion::settings() const {
  WindowSettings now = settings_;
  now.scope = scope_pane_.settings();
  return now;
}

void Companion::use_theme(Theme theme) {
  settings_.theme = theme;
  style_.palette = &palette(theme);
  apply_theme(*style_.palette, style_.scale);
}

void Companion::stop() {
  column_.cancel();
  desk_.session().send(protocol::Command::stop);
}

void Companion::key(const KeyEvent& event) {
  if (is_next_part(event)) keyboard_.go_on((event.modifiers & shift_modifier) != 0);
  if (event.action == GLFW_REPEAT) return;
  const int key = event.key;
  const bool down = event.action == GLFW_PRESS;
  const bool types = ImGui::GetIO().WantTextInput;
  if (down && (key == GLFW_KEY_ESCAPE || key == GLFW_KEY_F12 || (key == GLFW_KEY_SPACE && !types))) stop();
  if (down && key == GLFW_KEY_F1) key_help_.open();
  if (down && key >= GLFW_KEY_F2 && key < GLFW_KEY_F12 && !is_dialog_open())
    keyboard_.go_to(column_.show(static_cast<std::size_t>(key - GLFW_KEY_F2)));
  if (down && (event.modifiers & control_modifier) != 0 && !is_dialog_open()) {
    const char* name = glfwGetKeyName(key, event.scancode);  // follows the keyboard layout
    if (name != nullptr && name[0] != '\0' && name[1] == '\0') shortcuts_ += name[0];
  }
  if (!hand_ || (down && types)) return;
  if (key == GLFW_KEY_1) button_1_ = down;
  if (key == GLFW_KEY_2) button_2_ = down;
  if (key == GLFW_KEY_1 || key == GLFW_KEY_2) hand_->press_buttons(button_1_, button_2_);
}

void Companion::take_keyboard_shortcuts(double now_s) {
  const ImGuiIO& io = ImGui::GetIO();
  keyboard_.begin_frame();
  keep_modified_arrows();
  if (io.WantTextInput) return;
  if (io.InputQueueCharacters.contains('?')) key_help_.open();
  if (!io.KeyCtrl) return;
  // Key repetition is disabled, because each undo step may move a motor.
  const auto is_tapped = [](ImGuiKey key) { return ImGui::IsKeyPressed(key_index(key), false); };
  if (is_tapped(ImGuiKey_Z)) {
    if (io.KeyShift) {
      editor_.redo(now_s);
    } else {
      editor_.undo(now_s);
    }
  }
  if (is_tapped(ImGuiKey_Y)) editor_.redo(now_s);
}

void Companion::prepare() {
  if (fonts_.update()) style_.fonts = fonts_.fonts();
}

void Companion::take_shortcuts() {
  RecordingControls& recording = column_.recording_controls();
  const std::vector<protocol::Signal> signals = scope_pane_.signals();
  for (const char letter : std::exchange(shortcuts_, {})) {
    const bool can_toggle =
        !recording.recording_clock().empty() || recording.why_recording_waits(column_.scope_is_free(signals)).empty();
    if (letter == 'r' && can_toggle) recording.toggle_recording(signals);
    if (letter == 'm') recording.set_mark();
    if (letter == 's') recording.save_captured();
    if (letter == 'p') replay_bar_.is_open() ? replay_bar_.toggle_play() : scope_pane_.toggle_pause();
  }
}

NextStepSituation Companion::situation() const {
  return {.has_hand = hand_.has_value(), .is_replay = replay_bar_.is_open(), .force_waits = column_.why_force_waits()};
}

void Companion::follow_fault() {
  const auto& fault = desk_.view().status.fault;
  if (fault && fault != seen_fault_ && !replay_bar_.is_open()) scope_pane_.freeze_at_fault(fault->at_periods);
  seen_fault_ = fault;
  if (protocol::force_is_on(desk_.view().state())) scope_pane_.resume_after_fault();
}

void Companion::lay_out(ImVec2 size, double now_s) {
  arrived_ = desk_.newest_pose();
  follow_device(now_s);
  replay_bar_.follow(now_s, scope_pane_);
  take_keyboard_shortcuts(now_s);
  pose_ = replay_bar_.is_open() ? replay_bar_.pose() : desk_.view().pose;
  objects_move_ = objects_.follow(replay_bar_.is_open());

  take_shortcuts();
  follow_fault();

  const WindowLayout layout =
      layout_of(size,
                {.status_height = status_bar_.height(size.x, style_),
                 .replay_height = replay_bar_.is_open() ? style_.points(replay_bar_points) : 0.0f},
                settings_, style_.scale);
  const std::optional<Banner> banner =
      banner_of(desk_.view(), replay_bar_.is_open(), updater_.sight(), objects_.problem());
  const float height_of_banner = banner ? banner_height(layout.banner(0.0f).size.x, style_, *banner) : 0.0f;
  StatusBarOutcome outcome = draw_status_bar(layout);
  draw_scene(layout, height_of_banner, now_s, outcome);
  if (banner) draw_banner_over_scene(layout, *banner, height_of_banner, outcome);
  draw_column(layout, now_s);
  draw_scope(layout);
  draw_splitters(layout, size);
  key_help_.draw(style_);
  move_borders(layout, size);
  keyboard_.end_frame(style_);
  judge_motion();
  carry_out(outcome);  // the changes become visible in the next frame
  if (auto changes = editor_.take_changes(); !changes.empty()) desk_.session().set_parameters(std::move(changes));
}

void Companion::follow_device(double now_s) {
  if (desk_.has_choice()) {
    column_.cancel();  // trial values must be restored on the old device
    desk_.follow_choice();
  }
  follow_parameters(desk_.refresh(), now_s);
  const auto samples = desk_.take_scope();
  column_.follow({editor_, samples, now_s});
  const PaneStream stream = column_.stream(scope_pane_.signals());
  desk_.select_signals(stream.signals);
  if (!stream.feeds_scope || replay_bar_.is_open()) return;
  for (const device::ScopeSamples& each : samples) scope_pane_.receive(each);
}

void Companion::follow_parameters(const DeviceView& view, double now_s) {
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
  editor_.forget_unconfirmed(now_s);
  returned_.follow(view, now_s);
}

StatusBarOutcome Companion::draw_status_bar(const WindowLayout& layout) {
  const RecordingControls& recording = column_.recording_controls();
  return status_bar_.draw(
      layout.status.origin, layout.status.size, style_, desk_,
      {.scope_is_shown = settings_.scope_is_shown,
       .force_waits = why_force_waits(desk_.view(), situation()),
       .recording_waits = recording.why_recording_waits(column_.scope_is_free(scope_pane_.signals())),
       .recording_clock = recording.recording_clock()});
}

void Companion::draw_banner_over_scene(const WindowLayout& layout, const Banner& banner, float height,
                                       StatusBarOutcome& outcome) {
  const auto [origin, size] = layout.banner(height);
  switch (draw_banner(origin, size, style_, banner)) {
    case BannerAction::none: break;
    case BannerAction::clear_fault: outcome.clear_fault = true; break;
    case BannerAction::show_signals:
      settings_.scope_is_shown = true;
      scope_pane_.show_fault();
      break;
    case BannerAction::update_firmware: update_firmware(); break;
    case BannerAction::take_over: desk_.session().take_over(); break;
  }
}

void Companion::carry_out(const StatusBarOutcome& outcome) {
  if (outcome.stop) stop();
  if (outcome.switch_force_on) desk_.session().send(protocol::Command::enable_force);
  if (outcome.clear_fault) desk_.session().send(protocol::Command::clear_fault);
  if (outcome.help) key_help_.open();
  if (outcome.toggle_recording) column_.recording_controls().toggle_recording(scope_pane_.signals());
  if (outcome.mark) column_.recording_controls().set_mark();
  if (outcome.toggle_scope) settings_.scope_is_shown = !settings_.scope_is_shown;
  if (outcome.toggle_theme) use_theme(settings_.theme == Theme::dark ? Theme::light : Theme::dark);
}

void Companion::draw_scene(const WindowLayout& layout, float banner_height, double now_s, StatusBarOutcome& outcome) {
  const bool replays = replay_bar_.is_open();
  scene_ = layout.scene;
  const std::optional<NextStep> next_step =
      returned_.waits_for_user() ? std::nullopt : next_step_of(desk_.view(), situation());
  // Without a visible motion, the scene remains exactly the same, so that a partly redrawn picture is consistent.
  const std::optional<device::Pose>& shown = differs_visibly(drawn_pose_, pose_) ? pose_ : drawn_pose_;
  const bool is_taken = scene_pane_.draw(scene_.origin, scene_.size,
                                         {style_, shown, shown_parameters(), hand_ && !replays ? &*hand_ : nullptr,
                                          now_s, replays, next_step, banner_height, objects_});
  if (is_taken) take_next_step(next_step->action, outcome);
  if (replays) {
    replay_bar_.draw(layout.replay.origin, layout.replay.size, style_, scope_pane_);
  } else {
    draw_card(layout);
    if (!has_card() && returned_.is_shown()) draw_returned_values(layout, now_s);
  }
}

void Companion::take_next_step(NextAction action, StatusBarOutcome& outcome) {
  switch (action) {
    case NextAction::switch_force_on: outcome.switch_force_on = true; break;
    case NextAction::into_inkwell: hand_->reference_encoders(); break;
    case NextAction::measure_motors:
      desk_.session().send(protocol::Command::disable_force);
      keyboard_.go_to(column_.show("Guides"));
      column_.start_guide("current-loop");
      break;
    case NextAction::show_guides: keyboard_.go_to(column_.show("Guides")); break;
    case NextAction::show_log: keyboard_.go_to(column_.show("Log")); break;
  }
}

void Companion::draw_returned_values(const WindowLayout& layout, double now_s) {
  const ReturnChoice choice = draw_return_card(layout.scene.origin, layout.scene.size, style_, returned_,
                                               protocol::force_is_on(desk_.view().state()));
  if (choice == ReturnChoice::send) editor_.apply("old values", returned_.changes_back(), now_s);
  if (choice == ReturnChoice::keep) returned_.dismiss();
}

bool Companion::has_card() const {
  const DeviceView& view = desk_.view();
  return !view.connected() || has_firmware_card(updater_.sight(), view);
}

void Companion::draw_card(const WindowLayout& layout) {
  const DeviceView& view = desk_.view();
  updater_.search_boot_loader(!view.connected());
  updater_.meet(view.status.board_name);
  const auto firmware = updater_.sight();
  if (!has_card()) return;
  const auto outcome =
      draw_connection_card(layout.middle_of_scene(), style_, view, firmware, {may_start_virtual_board_, problem_});
  wants_virtual_board_ = outcome.starts_virtual_board;
  if (outcome.chosen_serial_number) desk_.choose(*outcome.chosen_serial_number);
  if (outcome.firmware.dismiss) updater_.dismiss();
  if (outcome.firmware.update) update_firmware();
}

void Companion::update_firmware() {
  column_.cancel();
  updater_.begin(desk_.wanted_serial_number());
}

void Companion::draw_column(const WindowLayout& layout, double now_s) {
  column_.draw(layout.column.origin, layout.column.size,
               {.style = style_,
                .editor = shown_parameters(),
                .is_replay = replay_bar_.is_open(),
                .scope_signals = scope_pane_.signals(),
                .now_s = now_s});
}

// The splitters are in front of the panes, because their sensitive areas are wider than the gaps between the panes.
void Companion::draw_splitters(const WindowLayout& layout, ImVec2 window) {
  const auto [origin, size] = layout.column_splitter;
  drag_column_splitter(splitter("tuning splitter", origin, size, true, style_), window, style_.scale, settings_);
  if (!settings_.scope_is_shown) return;
  const Rectangle& above_scope = layout.scope_splitter;
  drag_scope_splitter(splitter("scope splitter", above_scope.origin, above_scope.size, false, style_), layout,
                      style_.scale, settings_);
}

void Companion::move_borders(const WindowLayout& layout, ImVec2 window) {
  constexpr float step_points = 20.0f;
  const KeySteps steps = key_steps(with_alt);
  drag_column_splitter(step_points * static_cast<float>(steps.right), window, style_.scale, settings_);
  if (settings_.scope_is_shown)
    drag_scope_splitter(-step_points * static_cast<float>(steps.up), layout, style_.scale, settings_);
}

void Companion::draw_scope(const WindowLayout& layout) {
  if (!settings_.scope_is_shown) return;
  scope_pane_.draw(layout.scope.origin, layout.scope.size, style_, replay_bar_.is_open());
}

void Companion::judge_motion() {
  const bool scene_moves = differs_visibly(drawn_pose_, pose_);
  const bool is_updating = updater_.sight().phase == FirmwareUpdater::Phase::runs;
  is_moving_ = scene_moves || objects_move_ || is_updating || scope_pane_.saver().is_saving() || fonts_.is_loading() ||
               column_.is_moving() || replay_bar_.is_playing() ||
               (settings_.scope_is_shown && scope_pane_.take_motion());
  if (scene_moves) drawn_pose_ = pose_;
}

std::optional<Box> Companion::wanted_picture() const {
  if (const auto wanted = scope_pane_.saver().wanted_picture()) return wanted;
  const PlotSaver* saver = column_.plot_saver();
  return saver == nullptr ? std::nullopt : saver->wanted_picture();
}

void Companion::take_picture(Pixels pixels) {
  PlotSaver& saver = scope_pane_.saver().wanted_picture() ? scope_pane_.saver() : *column_.plot_saver();
  saver.take_picture(std::move(pixels));
}

bool Companion::needs_frame() const {
  return column_.is_moving() ||
         (!replay_bar_.is_open() && (differs_visibly(drawn_pose_, desk_.newest_pose()) || objects_.has_changed()));
}

std::uint64_t Companion::canvas_digest() const {
  PictureDigest digest;
  if (drawn_pose_) {
    const device::Pose& pose = *drawn_pose_;
    for (const auto& vector : {pose.position_m, pose.gimbal_rad, pose.force_N, pose.joint_rad})
      digest.add_bytes(vector, sizeof pose.position_m);
    digest.add(pose.state);
    digest.add(pose.fault);
    digest.add(pose.switches);
    digest.add(pose.is_referenced);
  }
  const auto parameters = shown_parameters().shown();
  digest.add_bytes(parameters.values.data(), parameters.values.size() * sizeof parameters.values[0]);
  digest.add(*style_.palette);
  objects_.add_to(digest);
  scene_pane_.add_to(digest);
  return digest.value();
}

Box Companion::canvas() const {
  return {scene_.origin.x, scene_.origin.y, scene_.origin.x + scene_.size.x, scene_.origin.y + scene_.size.y};
}

void Companion::paint(const Canvas& canvas) {
  const auto pixels = [&canvas](float units) { return static_cast<int>(std::lround(units * canvas.pixels_per_unit)); };
  const int height = pixels(scene_.size.y);
  scene_pane_.draw_scene(
      {pixels(scene_.origin.x), canvas.height_pixels - pixels(scene_.origin.y) - height, pixels(scene_.size.x), height},
      {*style_.palette, flat_colours_, canvas.smooth && !flat_colours_, canvas.is_as_before, std::nullopt});
}

nlohmann::json Companion::inspect() const {
  const DeviceView& view = desk_.view();
  nlohmann::json known{{"connected", view.connected()}, {"state", protocol::info(view.state()).name}};
  if (view.pose) known["pose_at_periods"] = view.pose->time_periods;
  known["plot_ranges"] = nlohmann::json::object();
  for (const auto& [title, range] : scope_pane_.drawn_ranges())
    known["plot_ranges"][title] = {range.minimum, range.maximum};
  known["missing_glyphs"] = fonts_.missing();
  known["fonts_are_loading"] = fonts_.is_loading();
  if (arrived_) known["arrived_at_periods"] = arrived_->time_periods;
  known["poses_lost"] = view.status.poses_lost;
  if (view.status.applied_at_periods) known["applied_at_periods"] = *view.status.applied_at_periods;
  return known;
}

std::optional<double> Companion::pose_age_s() const {
  const auto newest = desk_.newest_pose();
  const auto& drawn = desk_.view().pose;
  if (!newest || !drawn || replay_bar_.is_open()) return std::nullopt;
  return device::board_time_s(newest->time_periods - drawn->time_periods);
}

}  // namespace inkwell::window
