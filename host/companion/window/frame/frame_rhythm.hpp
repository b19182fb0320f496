// Decides when the window lays out and draws frames. Without a graphics card, drawing is slow. The window draws motion
// at the full rate and scrolling signals at a reduced rate. The window does not draw unchanged pictures.
#pragma once

namespace inkwell::window {

/// Properties of a laid-out frame.
struct FrameEvidence {
  bool input = false;    ///< from the user or the window system
  bool moves = false;    ///< visible motion without input
  bool differs = false;  ///< the picture differs from the picture on the screen
};

class FrameRhythm {
 public:
  /// Returns true if a frame must be laid out now. `something_happened` is true after input or while the device moves.
  bool is_due(bool something_happened, double now_s) const;
  /// Records the evidence of a laid-out frame. Returns true if the frame must be drawn.
  bool record_evidence(const FrameEvidence& evidence, double now_s);
  /// Sets the reduced rate according to the drawing time of a frame.
  void took(double drawing_s);
  /// Returns true while frames are drawn at the full rate.
  bool is_lively(double now_s) const { return now_s < lively_until_s_; }

  static constexpr double lively_for_s = 0.5;  ///< after the last input or motion
  static constexpr double resting_period_s = 1.0 / 6.0;
  static constexpr double resting_period_maximum_s = 0.5;
  static constexpr double resting_share = 1.0 / 14.0;  ///< fraction of the time at rest that drawing may use

 private:
  double resting_period_now_s_ = resting_period_s;
  double lively_until_s_ = 0.0;
  double laid_out_s_ = -1.0;
};

}  // namespace inkwell::window
