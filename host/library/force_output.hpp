// The thread that sends a program's forces, so that no caller waits for the USB.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <device/device.hpp>

#include "force_interval.hpp"
#include "pose_feed.hpp"

namespace inkwell::library {

/// Sends the newest force when the device has the one before. The USB takes one in a millisecond, and an old one is
/// worth nothing. In lock step it goes out before the next pose is asked for.
class ForceOutput : private TurnPart {
 public:
  /// Sends none while `poses` are lost.
  ForceOutput(device::Device& device, PoseFeed& poses);
  ~ForceOutput();

  void set_mode(protocol::ForceMode mode);
  /// `pose_sequence` is that of the newest pose that the program had seen when it computed the force. Throws
  /// BadArgument if it is not a finite number.
  void send(const double (&force_N)[3], std::uint32_t pose_sequence);
  /// The force is over, and fades.
  void let_go();
  /// Nothing is sent once this returns.
  void stop();

 private:
  void before_pose() override;
  void lose_link(const std::string& cause) override;
  void run();
  /// Sends the force that waits, if the device accepts the report before in time.
  void send_next(std::chrono::milliseconds patience);
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
  ForceInterval interval_;  ///< used by the thread that sends
  std::thread thread_;      ///< none in lock step, where the thread that reads poses sends
};

}  // namespace inkwell::library
