// How quickly frames came and how old their poses were, for `--frames-report`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace inkwell::window {

class FramesReport {
 public:
  /// `display_period_s`: a frame as the display shows it, by which poses are judged.
  explicit FramesReport(double display_period_s) : display_period_s_(display_period_s) {}
  /// A frame at the full rate: its period, the time to draw it, and how much newer the newest report was than the
  /// one drawn when the frame went to the screen.
  void add(double period_s, double drawing_s, std::optional<double> pose_age_s);
  std::string text() const;

 private:
  double display_period_s_;
  std::uint64_t frames_ = 0;
  double frames_s_ = 0.0;
  double drawing_s_ = 0.0;
  std::vector<double> pose_ages_s_;
  std::uint64_t poses_within_a_frame_ = 0;
};

}  // namespace inkwell::window
