// When the window lays out a frame, and when it draws it. Drawing is dear without a graphics card, so a window at rest
// does it seldom: at the full rate while something moves, a few times a second while only resting signals scroll, and
// not at all while the picture would stay the same.
#pragma once

namespace inkwell::window {

/// What is known of a frame before it is drawn.
struct FrameEvidence {
  bool input = false;    ///< from the user or the window system
  bool moves = false;    ///< something changes by itself, by more than a pixel shows
  bool differs = false;  ///< the picture is not the one that is on the screen
};

class FrameRhythm {
 public:
  /// Whether a frame is to be laid out now. `something_happened`: input, or a device that moves.
  bool is_due(bool something_happened, double now_s) const;
  /// Whether the frame that was laid out is to be drawn.
  bool is_to_be_drawn(const FrameEvidence& evidence, double now_s);
  /// How long it took to draw a frame at rest: where it takes long, they are drawn more seldom.
  void took(double drawing_s);
  /// Frames follow one another at the full rate.
  bool is_lively(double now_s) const { return now_s < lively_until_s_; }

  static constexpr double lively_for_s = 0.5;  ///< after the last input or motion
  static constexpr double resting_period_s = 1.0 / 6.0;
  static constexpr double resting_period_maximum_s = 0.5;
  static constexpr double resting_share = 1.0 / 14.0;  ///< of the time at rest, for drawing

 private:
  double resting_period_now_s_ = resting_period_s;
  double lively_until_s_ = 0.0;
  double laid_out_s_ = -1.0;
};

}  // namespace inkwell::window
