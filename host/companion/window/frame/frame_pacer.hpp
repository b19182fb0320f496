// Limits the frame rate.
#pragma once

namespace inkwell::window {

/// Limits the frame rate by sleeping, because some displays do not limit the rate.
class FramePacer {
 public:
  /// `keeps_up`: result of keeps_up() before the first measurement.
  FramePacer(double frames_per_second, bool keeps_up) : period_s_(1.0 / frames_per_second), keeps_up_(keeps_up) {}
  void wait();
  /// Announces a pause until the next call of wait(). The pause does not count as a slow frame.
  void rest() { half_second_began_s_ = 0.0; }

  /// True while frames are on time. Permanently false after half a second of frames that were 20 % too slow.
  bool keeps_up() const { return keeps_up_; }

 private:
  double period_s_;
  double next_s_ = 0.0;
  double half_second_began_s_ = 0.0;
  int frames_in_it_ = 0;
  bool keeps_up_;
};

}  // namespace inkwell::window
