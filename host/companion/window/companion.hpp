// The companion's window with all panes.
#pragma once

#include <optional>
#include <string>

#include "host/companion/window/bars/banner.hpp"
#include "host/companion/window/bars/firmware_updater.hpp"
#include "host/companion/window/bars/key_help.hpp"
#include "host/companion/window/bars/replay_bar.hpp"
#include "host/companion/window/bars/status_bar.hpp"
#include "host/companion/window/device_desk/device_desk.hpp"
#include "host/companion/window/device_desk/next_step.hpp"
#include "host/companion/window/device_desk/parameter_editor.hpp"
#include "host/companion/window/device_desk/returned_values.hpp"
#include "host/companion/window/frame/frame_loop.hpp"
#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/panes/pane_column.hpp"
#include "host/companion/window/scene/mouse_hand.hpp"
#include "host/companion/window/scene/scene_objects.hpp"
#include "host/companion/window/scene/scene_pane.hpp"
#include "host/companion/window/scope/scope_pane.hpp"
#include "host/companion/window/window_layout.hpp"
#include "host/companion/window/window_options.hpp"
#include "host/companion/window/window_settings.hpp"

namespace inkwell::window {

class Companion final : public FrameContent {
 public:
  /// `problem` is the error message of the last virtual board start, or empty.
  Companion(const WindowOptions& options, const WindowSettings& settings, float scale, std::string problem);

  /// Handles the keys. Escape, F12 and the space bar switch the force off immediately. In text fields, the space bar
  /// only types a space.
  void key(const KeyEvent& event) override;
  bool needs_frame() const override;
  void prepare() override;
  void lay_out(ImVec2 size, double now_s) override;
  bool is_moving() const override { return is_moving_; }
  /// Returns true after the user has requested a virtual board. The caller then restarts the window.
  bool is_over() const override { return wants_virtual_board_; }
  Box canvas() const override;
  std::uint64_t canvas_digest() const override;
  std::optional<Box> wanted_picture() const override;
  void take_picture(Pixels pixels) override;
  Colour ground() const override { return style_.palette->pane; }
  void paint(const Canvas& canvas) override;
  nlohmann::json inspect() const override;
  std::optional<double> pose_age_s() const override;

  /// Returns the current window settings.
  WindowSettings settings() const;

 private:
  void follow_device(double now_s);
  void follow_parameters(const DeviceView& view, double now_s);
  void take_keyboard_shortcuts(double now_s);
  /// Moves the splitters while Alt and an arrow key are pressed.
  void move_borders(const WindowLayout& layout, ImVec2 window);

  /// Handles the keys with Ctrl that were pressed since the last frame.
  void take_shortcuts();
  NextStepSituation situation() const;
  StatusBarOutcome draw_status_bar(const WindowLayout& layout);
  void draw_banner_over_scene(const WindowLayout& layout, const Banner& banner, float height,
                              StatusBarOutcome& outcome);
  void draw_scene(const WindowLayout& layout, float banner_height, double now_s, StatusBarOutcome& outcome);
  void take_next_step(NextAction action, StatusBarOutcome& outcome);
  /// Freezes the scope at a new fault, and resumes the scope when the force is on again.
  void follow_fault();
  void draw_splitters(const WindowLayout& layout, ImVec2 window);
  void draw_returned_values(const WindowLayout& layout, double now_s);
  void draw_column(const WindowLayout& layout, double now_s);
  void draw_scope(const WindowLayout& layout);
  void judge_motion();

  /// Returns true if the connection card is shown.
  bool has_card() const;
  void draw_card(const WindowLayout& layout);
  void update_firmware();
  void carry_out(const StatusBarOutcome& outcome);
  void use_theme(Theme theme);
  void stop();

  /// Returns the parameter editor of the replayed recording or, without a replay, of the device.
  ParameterEditor& shown_parameters() { return replay_bar_.is_open() ? replay_bar_.editor() : editor_; }
  const ParameterEditor& shown_parameters() const { return replay_bar_.is_open() ? replay_bar_.editor() : editor_; }

  bool flat_colours_;
  bool may_start_virtual_board_;
  bool wants_virtual_board_ = false;
  std::string problem_;
  WindowSettings settings_;
  FontLoader fonts_;
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
  SceneObjects objects_;
  ScenePane scene_pane_;
  ScopePane scope_pane_;
  PaneColumn column_;

  std::uint64_t seen_revision_ = 0;
  std::string seen_refusal_;
  std::string shortcuts_;  ///< letters that were pressed with Ctrl since the last frame
  std::optional<device::NoticedFault> seen_fault_;
  Rectangle scene_;                         ///< position in the last layout
  std::optional<device::Pose> arrived_;     ///< the device's newest pose at the start of the frame
  std::optional<device::Pose> pose_;        ///< displayed pose, from the device or from the recording
  std::optional<device::Pose> drawn_pose_;  ///< last pose that differed visibly from the previous pose
  bool objects_move_ = false;
  bool is_moving_ = true;
  bool button_1_ = false;
  bool button_2_ = false;
};

}  // namespace inkwell::window
