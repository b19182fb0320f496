#include "pacer.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace inkwell::dropins {
namespace {

constexpr double look_up_s = 0.1;     ///< how soon a stop is noticed when no pose comes
constexpr int looks_of_silence = 20;  /// after as many a device counts as silent

}  // namespace

void Pacer::wait_by_clock(std::uint32_t milliseconds) {
  clock_ = std::max(clock_, std::chrono::steady_clock::now() - std::chrono::milliseconds(milliseconds)) +
           std::chrono::milliseconds(milliseconds);
  std::this_thread::sleep_until(clock_);
}

double Pacer::wait(std::uint32_t poses, const std::function<bool()>& ends) {
  std::shared_ptr<Device> device;
  {
    const std::lock_guard lock(devices_.mutex());
    device = devices_.pacing();
  }
  if (!device) {
    wait_by_clock(poses);
    return 0.0;
  }
  const bool is_new = before_.lock() != device;
  before_ = device;
  for (int look = 0; look < looks_of_silence && !ends();) {
    inkwell_pose pose;
    const auto result = inkwell_wait_for_pose(device->arm(), look_up_s, &pose);
    if (result == INKWELL_TIMED_OUT) {
      ++look;
    } else if (result != INKWELL_OK) {
      break;
    } else if (is_new || pose.sequence - sequence_ >= poses) {
      sequence_ = pose.sequence;
      const double before_s = std::exchange(time_s_, pose.time_s);
      return is_new ? 0.0 : time_s_ - before_s;
    }
  }
  if (!ends()) device->set_silent(true);
  return 0.0;
}

}  // namespace inkwell::dropins
