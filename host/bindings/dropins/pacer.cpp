#include "host/bindings/dropins/pacer.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace inkwell::dropins {
namespace {

constexpr double poll_s = 0.1;  ///< longest delay of a stop while no poses arrive

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
    before_.reset();
    wait_by_clock(poses);
    return 0.0;
  }
  const bool is_new = before_.lock() != device;
  before_ = device;
  while (!ends()) {
    inkwell_pose pose;
    const auto result = inkwell_wait_for_pose(device->arm(), poll_s, &pose);
    if (result == INKWELL_OK && (is_new || pose.sequence - sequence_ >= poses)) {
      sequence_ = pose.sequence;
      const double passed_s = pose.time_s - std::exchange(time_s_, pose.time_s);
      return is_new ? 0.0 : std::max(0.0, passed_s);
    }
    if (result != INKWELL_OK && !device->sends_poses()) break;
  }
  return 0.0;
}

}  // namespace inkwell::dropins
