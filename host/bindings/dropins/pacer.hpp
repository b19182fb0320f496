// Derives the scheduler's ticks from the poses of the first device that sends poses, or from the computer's clock if no
// device sends poses.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "host/bindings/dropins/devices.hpp"

namespace inkwell::dropins {

class Pacer {
 public:
  explicit Pacer(Devices& devices) : devices_(devices) {}

  /// Waits until this number of poses has arrived since the last call, or until `ends` returns true. Returns the board
  /// time between the ticks, or 0 if it is unknown.
  double wait(std::uint32_t poses, const std::function<bool()>& ends);

 private:
  void wait_by_clock(std::uint32_t milliseconds);

  Devices& devices_;
  std::weak_ptr<Device> before_;
  std::uint32_t sequence_ = 0;
  double time_s_ = 0.0;
  std::chrono::steady_clock::time_point clock_{};
};

}  // namespace inkwell::dropins
