// When the frames of the bus begin: TIM2 captures its count at each start of frame, in hardware, so that no interrupt
// that runs at that moment falsifies it (RM0090, "Peripheral SOFs": the core's pulse is one of TIM2's triggers).
#pragma once

#include <cstdint>
#include <optional>

#include <usb/port.hpp>

namespace inkwell::drivers {

/// A part of OtgFs, which claims TIM2 and starts its clock.
class FrameClock {
 public:
  /// `frames` are counted already.
  constexpr explicit FrameClock(std::uint32_t frames) : count_(frames) {}

  void start();

  /// The bus has fallen silent: no frame is known until the next one begins.
  void forget() { is_known_ = false; }

  /// The newest frame; none while the bus is silent. To be called once in a frame at least.
  std::optional<usb::BusFrame> newest();

 private:
  void note_capture();

  bool is_known_ = false;
  std::uint16_t number_ = 0;
  std::uint32_t count_;         ///< of frames; wraps
  std::uint32_t captured_ = 0;  ///< TIM2's count at the start of frame
  std::uint32_t length_ = 0;    ///< of a frame in TIM2's counts, as measured last
};

}  // namespace inkwell::drivers
