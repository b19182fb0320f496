// When the scheduler's ticks begin: at the poses of the first device that sends some, else by the computer's clock.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "devices.hpp"

namespace inkwell::dropins {

class Pacer {
 public:
  explicit Pacer(Devices& devices) : devices_(devices) {}

  /// Waits until as many poses have come since the last call, or `ends`. Returns the board time that passed from tick
  /// to tick, 0 if that is not known.
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
