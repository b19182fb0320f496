// The window's run loop: when to lay out a frame, when to draw it, and who is told of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <imgui.h>
#include <nlohmann/json_fwd.hpp>

#include <frame/display.hpp>
#include <frame/frame_pacer.hpp>
#include <frame/frame_rhythm.hpp>
#include <frame/frames_report.hpp>
#include <frame/imgui_frames.hpp>
#include <frame/inspection.hpp>
#include <frame/palette.hpp>
#include <frame/picture_changes.hpp>
#include <frame/picture_mark.hpp>

namespace inkwell::window {

/// The framebuffer in which what lies under the panes is painted.
struct Canvas {
  float pixels_per_unit;  ///< of screen coordinates
  int height_pixels;
  bool smooth;        ///< there is time for a smooth picture
  bool is_as_before;  ///< it would be the picture that was painted last
};

/// What the loop shows, frame by frame.
class FrameContent {
 public:
  virtual ~FrameContent() = default;

  /// A key went down or up, whatever has the focus.
  virtual void key(const KeyEvent& event) = 0;
  /// Whether something has changed visibly since the last frame. Cheap: it is asked while the window rests.
  virtual bool asks_for_frame() const = 0;

  /// Lays out every pane; ImGui's frame is open.
  virtual void lay_out(ImVec2 size, double now_s) = 0;
  /// Something in the frame that was laid out changes by itself, so that it has to be drawn at the full rate.
  virtual bool is_moving() const = 0;
  /// It has ended by itself, and the loop ends with it.
  virtual bool is_over() const { return false; }
  /// Where something is painted under the panes, in screen coordinates.
  virtual Box canvas() const = 0;
  /// Of all that is painted there, as it was laid out: the same for the same picture.
  virtual std::uint64_t canvas_digest() const = 0;

  /// The colour of the panes' ground.
  virtual Colour ground() const = 0;
  /// Paints what lies under the panes into the framebuffer, whose depth and stencil have been cleared there.
  virtual void paint(const Canvas& canvas) = 0;

  /// What is known in the frame that was laid out, for an inspection.
  virtual nlohmann::json inspect() const = 0;
  /// How much newer the newest pose that has arrived is than the one of this frame, in board time; none if none is
  /// shown.
  virtual std::optional<double> pose_age_s() const = 0;
};

struct FrameLoopOptions {
  std::filesystem::path screenshot;  ///< with it: write the framebuffer to this PNG and end
  double after_seconds = 3.0;        ///< when the screenshot is taken, from the start on
  Inspection* inspection = nullptr;  ///< answers questions about the frames; null: nobody asks
  bool frames_report = false;        ///< print the measured frames per second at the end
};

/// From now on SIGINT, SIGTERM and SIGHUP end the loop as the window's own button does: force off, parameters on trial
/// put back, settings kept.
void end_loop_at_signals();

class FrameLoop {
 public:
  FrameLoop(Display& display, ImGuiFrames& imgui, FrameContent& content, FrameLoopOptions options);

  /// Returns once the window is closed, its content is over, a signal came or the screenshot is taken. Throws
  /// DisplayError.
  void run();

 private:
  struct Frame {
    double now_s;
    Display::Size size;
    bool is_lively;  ///< one of many at the full rate
    bool is_asked;   ///< by an inspection
    bool is_last;
    bool smooth;
    FrameEvidence evidence;
    DrawnPicture picture;
  };

  Frame next_frame();
  bool is_due(const Frame& frame) const;
  void lay_out(Frame& frame);
  bool is_to_be_drawn(Frame& frame);
  void draw(const Frame& frame);
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
  double shown_s_;  ///< when the last frame that was shown began
  DrawnPicture on_screen_;
  PictureMark mark_;  ///< of it
};

}  // namespace inkwell::window
