// The window's parts put together: one frame of the companion.
#pragma once

#include <memory>
#include <optional>

#include <nlohmann/json_fwd.hpp>

#include <bars/replay_bar.hpp>
#include <bars/status_bar.hpp>
#include <device_desk/device_desk.hpp>
#include <device_desk/parameter_editor.hpp>
#include <frame/style.hpp>
#include <panes/guides_pane.hpp>
#include <panes/recording_pane.hpp>
#include <panes/tuning_pane.hpp>
#include <scene/mouse_hand.hpp>
#include <scene/scene_pane.hpp>
#include <scope/scope_pane.hpp>
#include <window/window.hpp>
#include <window/window_settings.hpp>

namespace inkwell::window {

class Companion {
 public:
  Companion(const WindowOptions& options, const WindowSettings& settings, float scale);

  /// Lays out and draws every pane; ImGui's frame is open.
  void draw(ImVec2 size, double now_s);
  /// The picture under the panes; the framebuffer is bound. `pixels_per_unit`: framebuffer over screen coordinates.
  /// `is_as_before`: the scene is the one that was drawn last, by its digest.
  void draw_scene(float pixels_per_unit, int framebuffer_height, bool smooth, bool is_as_before) const;
  /// Of all that the scene is made of, as it was laid out last.
  std::uint64_t scene_digest() const;

  /// A key went down or up, whatever has the focus. The space bar stops at once.
  void key(int key, bool down);
  /// Whether the device differs visibly from the last picture of it. Cheap: it needs no frame.
  bool device_moves() const;
  /// Something in the frame that was laid out changes by itself, so that it has to be drawn at the full rate.
  bool is_moving() const { return is_moving_; }
  /// The newest report that has arrived by now; `draw` takes it up.
  std::optional<protocol::PoseReport> newest_arrived() { return desk_.session().newest_pose(); }
  /// What is known of the device in this frame, for an inspection; `arrived`: the newest report when it began.
  nlohmann::json inspect(const std::optional<protocol::PoseReport>& arrived) const;
  /// How much newer the newest report that has arrived by now is than the one that this frame shows, in board
  /// time; none while there is no device to show.
  std::optional<double> pose_age_s();
  const Palette& colours() const { return *style_.palette; }
  /// As they stand now, to be remembered.
  WindowSettings settings() const;

 private:
  enum class Tab : std::uint8_t { tuning, guides, recording };

  void follow_device(double now_s);
  void keyboard_shortcuts(double now_s);
  void use_theme(Theme theme);
  void carry_out(const StatusBarOutcome& outcome);
  float splitter(const char* name, ImVec2 place, ImVec2 size, bool vertical) const;
  void stop();
  void follow_replay(double now_s);
  /// The tabs over the right column; returns their height.
  float draw_tabs(ImVec2 place, float width);

  WindowOptions options_;
  WindowSettings settings_;
  Style style_;
  DeviceDesk desk_;
  std::optional<MouseHand> hand_;
  ParameterEditor editor_;
  StatusBar status_bar_;
  ScenePane scene_pane_;
  TuningPane tuning_pane_;
  ScopePane scope_pane_;
  GuidesPane guides_pane_;
  RecordingPane recording_pane_;
  ReplayBar replay_bar_;
  Tab tab_ = Tab::tuning;
  std::uint64_t seen_revision_ = 0;
  std::string seen_refusal_;
  bool file_is_to_be_sent_;
  ImVec2 scene_place_{0, 0};
  ImVec2 scene_size_{1, 1};
  std::optional<protocol::PoseReport> drawn_pose_;
  bool is_moving_ = true;
  bool button_1_ = false;
  bool button_2_ = false;
};

}  // namespace inkwell::window
