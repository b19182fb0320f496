// The main loop of the window. Lays out and draws frames when necessary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <imgui.h>
#include <nlohmann/json_fwd.hpp>

#include "host/companion/window/frame/display.hpp"
#include "host/companion/window/frame/frame_pacer.hpp"
#include "host/companion/window/frame/frame_rhythm.hpp"
#include "host/companion/window/frame/frames_report.hpp"
#include "host/companion/window/frame/imgui_frames.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/palette.hpp"
#include "host/companion/window/frame/picture_changes.hpp"
#include "host/companion/window/frame/picture_mark.hpp"

namespace inkwell::window {

/// Drawing target for the scene.
struct Canvas {
  float pixels_per_unit;  ///< pixels per unit of screen coordinates
  int height_pixels;
  bool smooth;        ///< true: antialiased
  bool is_as_before;  ///< true: the picture equals the previous picture
};

/// Interface of the window's content.
class FrameContent {
 public:
  virtual ~FrameContent() = default;

  /// Handles a key event, regardless of the keyboard focus.
  virtual void key(const KeyEvent& event) = 0;
  /// Returns true if the content has changed visibly since the last frame. The function must be fast, because the idle
  /// loop calls the function 60 times per second.
  virtual bool needs_frame() const = 0;

  /// Prepares the next frame, before ImGui's NewFrame().
  virtual void prepare() {}
  /// Lays out all panes between ImGui's NewFrame() and Render().
  virtual void lay_out(ImVec2 size, double now_s) = 0;
  /// Returns true if the laid-out frame contains motion and needs the full frame rate.
  virtual bool is_moving() const = 0;
  /// Returns true if the loop must stop.
  virtual bool is_over() const { return false; }
  /// Area of the scene, in screen coordinates.
  virtual Box canvas() const = 0;
  /// Digest of the laid-out scene. Equal digests mean equal pictures.
  virtual std::uint64_t canvas_digest() const = 0;

  /// Background color of the panes.
  virtual Colour ground() const = 0;
  /// Paints the scene behind the panes. The depth and stencil buffers of the scene area are already clear.
  virtual void paint(const Canvas& canvas) = 0;

  /// Returns the area of a requested picture, in screen coordinates; empty without a request.
  virtual std::optional<Box> wanted_picture() const { return std::nullopt; }
  virtual void take_picture(Pixels) {}

  /// Returns the state of the frame for an inspection.
  virtual nlohmann::json inspect() const = 0;
  /// Returns the board time between the drawn pose and the newest received pose; empty if no pose is drawn.
  virtual std::optional<double> pose_age_s() const = 0;
};

struct FrameLoopOptions {
  std::filesystem::path screenshot;  ///< if set: write the framebuffer to this PNG file and exit
  double after_seconds = 3.0;        ///< time of the screenshot after the start
  Inspection* inspection = nullptr;  ///< answers requests about the frames; null: no inspection
  bool frames_report = false;        ///< print the measured frame rate at exit
};

/// After this call, SIGINT, SIGTERM and SIGHUP close the window. When the window closes, the program switches the force
/// off, restores trial parameters and saves the settings.
void end_loop_at_signals();

class FrameLoop {
 public:
  FrameLoop(Display& display, ImGuiFrames& imgui, FrameContent& content, FrameLoopOptions options);

  /// Runs until the window is closed, the content stops the loop, a signal arrives, or the screenshot is written.
  /// Throws DisplayError.
  void run();

 private:
  struct Frame {
    double now_s;
    Display::Size size;
    bool is_lively;  ///< part of a sequence at the full rate
    bool is_asked;   ///< requested by an inspection
    bool is_last;
    bool smooth;
    FrameEvidence evidence;
    DrawnPicture picture;
  };

  Frame next_frame();
  bool is_due(const Frame& frame) const;
  void lay_out(Frame& frame);
  bool update_evidence(Frame& frame);
  void draw(const Frame& frame);
  void take_picture(const Frame& frame, const Box& box);
  std::vector<Box> to_be_drawn(const Frame& frame) const;
  void draw_part(const Frame& frame, const Box& box);
  void show(const Frame& frame);

  Display& display_;
  ImGuiFrames& imgui_;
  FrameContent& content_;
  FrameLoopOptions options_;
  Inspection* inspection_;
  FramePacer pacer_;
  FrameRhythm rhythm_;
  FramesReport frames_report_;
  double started_s_;
  double shown_s_;  ///< start time of the last shown frame
  DrawnPicture on_screen_;
  PictureMark mark_;  ///< for `on_screen_`
};

}  // namespace inkwell::window
