// The thread that sends a program's forces, so that no caller waits for the USB.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include <device/device.hpp>

#include "force_interval.hpp"
#include "pose_feed.hpp"

namespace inkwell::library {

/// Sends the newest force when the device has the one before. The USB takes one in a millisecond, and an old one is
/// worth nothing.
class ForceOutput {
 public:
  /// Sends none while `poses` are lost.
  ForceOutput(device::Device& device, PoseFeed& poses);
  ~ForceOutput();

  void set_mode(protocol::ForceMode mode);
  /// `pose_sequence` is that of the newest pose that the program had seen when it computed the force. Throws
  /// BadArgument for what is no finite number.
  void send(const double (&force_N)[3], std::uint32_t pose_sequence);
  /// The force is over, and fades.
  void let_go();
  /// Nothing is sent once this returns.
  void stop();

 private:
  void run();
  /// False after stop().
  bool wait_for_force();
  device::ForceRequest take_force();
  void drop_force();

  device::Device& device_;
  PoseFeed& poses_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<device::ForceRequest> next_;
  protocol::ForceMode mode_ = protocol::ForceMode::instead_of_walls;
  bool stops_ = false;
  std::thread thread_;
};

}  // namespace inkwell::library
