// Frame rate and pose age for `--frames-report`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace inkwell::window {

class FramesReport {
 public:
  /// `display_period_s` is the frame period of the display.
  explicit FramesReport(double display_period_s) : display_period_s_(display_period_s) {}
  /// Adds a frame at the full rate. `pose_age_s` is the board time between the drawn pose and the newest received pose.
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
