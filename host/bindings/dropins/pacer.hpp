// Derives the scheduler ticks from a device's poses, or from the PC clock if no device sends poses.
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
  /// time between the ticks, or 0 if the time is unknown.
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
