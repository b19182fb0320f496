// Start times of the bus frames. TIM2 captures its count at each start of frame in hardware, so interrupts do not
// affect the result. The start-of-frame pulse of the core is a trigger of TIM2 (RM0090, "Peripheral SOFs").
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/usb/port.hpp"

namespace inkwell::drivers {

/// OtgFs claims TIM2 for this class and starts the TIM2 clock.
class FrameClock {
 public:
  /// `frames` is the initial frame count.
  constexpr explicit FrameClock(std::uint32_t frames) : count_(frames) {}

  void start();

  /// Call this function when the bus has become silent. After the call, newest() returns nothing until the next start
  /// of frame.
  void forget() { is_known_ = false; }

  /// Returns the newest frame, or nothing while the bus is silent. Call this function at least once per frame.
  std::optional<usb::BusFrame> newest();

 private:
  void note_capture();

  bool is_known_ = false;
  std::uint16_t number_ = 0;
  std::uint32_t count_;         ///< number of frames; wraps
  std::uint32_t captured_ = 0;  ///< TIM2 count at the start of frame
  std::uint32_t length_ = 0;    ///< last measured frame length in TIM2 counts
};

}  // namespace inkwell::drivers
