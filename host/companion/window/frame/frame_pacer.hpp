// Limits the frame rate.
#pragma once

namespace inkwell::window {

/// Sleeps between frames, because some displays do not limit the frame rate.
class FramePacer {
 public:
  /// `keeps_up` is the initial result of keeps_up().
  FramePacer(double frames_per_second, bool keeps_up) : period_s_(1.0 / frames_per_second), keeps_up_(keeps_up) {}
  void wait();
  /// Excludes the time until the next call of wait() from the frame rate measurement.
  void rest() { half_second_began_s_ = 0.0; }

  /// Returns false once frames were 20 % too slow for half a second.
  bool keeps_up() const { return keeps_up_; }

 private:
  double period_s_;
  double next_s_ = 0.0;
  double half_second_began_s_ = 0.0;
  int frames_in_it_ = 0;
  bool keeps_up_;
};

}  // namespace inkwell::window
