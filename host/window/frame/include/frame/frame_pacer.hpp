// The steady rate of frames.
#pragma once

namespace inkwell::window {

/// Sleeps so that frames come at a steady rate where the display does not hold them back itself.
class FramePacer {
 public:
  /// `keeps_up`: what to suppose until frames tell.
  FramePacer(double frames_per_second, bool keeps_up) : period_s_(1.0 / frames_per_second), keeps_up_(keeps_up) {}
  void wait();
  /// No frame is wanted for a while: what passes until the next `wait` is no slowness.
  void rest() { half_second_began_s_ = 0.0; }

  /// True while the frames come as they should; false once half a second of them was a fifth too slow, for good.
  bool keeps_up() const { return keeps_up_; }

 private:
  double period_s_;
  double next_s_ = 0.0;
  double half_second_began_s_ = 0.0;
  int frames_in_it_ = 0;
  bool keeps_up_;
};

}  // namespace inkwell::window
