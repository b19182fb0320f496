#include "host/companion/window/frame/frame_pacer.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace inkwell::window {

void FramePacer::wait() {
  using Clock = std::chrono::steady_clock;
  const double now_s = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  // A late frame restarts the schedule, which prevents a burst of frames.
  next_s_ = std::max(next_s_ + period_s_, now_s - period_s_);
  if (next_s_ > now_s) std::this_thread::sleep_for(std::chrono::duration<double>(next_s_ - now_s));

  if (const double measured_s = now_s - half_second_began_s_; measured_s > 0.5) {
    if (half_second_began_s_ > 0.0 && measured_s > 1.2 * period_s_ * frames_in_it_) keeps_up_ = false;
    half_second_began_s_ = now_s;
    frames_in_it_ = 0;
  }
  ++frames_in_it_;
}

}  // namespace inkwell::window
