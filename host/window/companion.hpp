// The window's rooms put together: one frame of the companion.
#pragma once

#include <optional>
#include <string>

#include <bars/banner.hpp>
#include <bars/firmware_updater.hpp>
#include <bars/key_help.hpp>
#include <bars/replay_bar.hpp>
#include <bars/status_bar.hpp>
#include <device_desk/device_desk.hpp>
#include <device_desk/parameter_editor.hpp>
#include <device_desk/returned_values.hpp>
#include <frame/frame_loop.hpp>
#include <frame/keyboard.hpp>
#include <frame/style.hpp>
#include <panes/pane_column.hpp>
#include <scene/mouse_hand.hpp>
#include <scene/scene_pane.hpp>
#include <scope/scope_pane.hpp>
#include <window/window_layout.hpp>
#include <window/window_options.hpp>
#include <window/window_settings.hpp>

namespace inkwell::window {

class Companion final : public FrameContent {
 public:
  /// `problem`: why no virtual board could be started when it was asked for; empty if none was.
  Companion(const WindowOptions& options, const WindowSettings& settings, float scale, std::string problem);

  /// Escape, F12 and the space bar stop at once; the space bar not while a text is typed.
  void key(const KeyEvent& event) override;
  bool asks_for_frame() const override;
  void lay_out(ImVec2 size, double now_s) override;
  bool is_moving() const override { return is_moving_; }
  /// The user asks for a virtual board, with which the window begins anew.
  bool is_over() const override { return wants_virtual_board_; }
  Box canvas() const override;
  std::uint64_t canvas_digest() const override;
  Colour ground() const override { return style_.palette->pane; }
  void paint(const Canvas& canvas) override;
  nlohmann::json inspect() const override;
  std::optional<double> pose_age_s() const override;

  /// As they stand now, to be remembered.
  WindowSettings settings() const;

 private:
  void follow_device(double now_s);
  void follow_parameters(const DeviceView& view, double now_s);
  void take_keyboard_shortcuts(double now_s);
  /// Alt with the arrows: what a mouse does with the lines between the parts.
  void move_borders(const WindowLayout& layout, ImVec2 window);

  /// The room that the layout leaves a banner: what somebody holds with the mouse stays where it is.
  float banner_room(float banner_height);
  StatusBarOutcome draw_bars(const WindowLayout& layout, const std::optional<Banner>& banner);
  /// True if the user asks there for the force.
  bool draw_scene(const WindowLayout& layout, double now_s);
  void draw_returned_values(const WindowLayout& layout, double now_s);
  void draw_column(const WindowLayout& layout, ImVec2 window, double now_s);
  void draw_scope(const WindowLayout& layout);
  void judge_motion();

  /// In the middle of the scene: no device, or an update.
  bool has_card() const;
  void draw_card(const WindowLayout& layout);
  void update_firmware();
  void carry_out(const StatusBarOutcome& outcome);
  void use_theme(Theme theme);
  void stop();

  /// Of the device, or of the recording that is replayed in its place.
  ParameterEditor& shown_parameters() { return replay_bar_.is_open() ? replay_bar_.editor() : editor_; }
  const ParameterEditor& shown_parameters() const { return replay_bar_.is_open() ? replay_bar_.editor() : editor_; }

  bool flat_colours_;
  bool may_start_virtual_board_;
  bool wants_virtual_board_ = false;
  std::string problem_;
  WindowSettings settings_;
  Style style_;
  DeviceDesk desk_;
  std::optional<MouseHand> hand_;
  ParameterEditor editor_;
  ReturnedValues returned_;
  StatusBar status_bar_;
  ReplayBar replay_bar_;
  KeyHelp key_help_;
  KeyboardTour keyboard_;
  FirmwareUpdater updater_;
  ScenePane scene_pane_;
  ScopePane scope_pane_;
  PaneColumn column_;

  std::uint64_t seen_revision_ = 0;
  std::string seen_refusal_;
  float banner_room_ = 0.0f;                ///< in the frame before
  Rectangle scene_;                         ///< where it was laid out last
  std::optional<device::Pose> arrived_;     ///< the device's newest when the frame began
  std::optional<device::Pose> pose_;        ///< that the frame shows: the device's, or the recording's
  std::optional<device::Pose> drawn_pose_;  ///< the last one that looked different from the one before
  bool is_moving_ = true;
  bool button_1_ = false;
  bool button_2_ = false;
};

}  // namespace inkwell::window
