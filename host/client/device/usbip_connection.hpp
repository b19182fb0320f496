// An imported USB/IP device. A separate thread receives its answers.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "host/client/device/error.hpp"
#include "host/client/device/transport.hpp"
#include "protocol/usbip/messages.hpp"

#include "host/client/device/socket.hpp"
#include "host/client/device/usb_descriptors.hpp"
#include "host/client/device/usbip_answers.hpp"

namespace inkwell::device {

/// Lists the devices of a USB/IP server. Throws Error if no USB/IP server answers within 3 s.
std::vector<UsbipDevice> list_usbip_devices(const SocketAddress& server);

class UsbipConnection {
 public:
  /// A request lasts some milliseconds of board time, but a virtual board may be much slower than real time.
  static constexpr auto control_timeout = std::chrono::seconds(15);

  using Completion = UsbipCompletion;
  using OnCompletion = OnUsbipCompletion;

  /// Imports the device. Throws Error if the device is not available or the peer is not a USB/IP server. Call start()
  /// before the first transfer. `timeout` limits the duration of a control transfer.
  UsbipConnection(const SocketAddress& server, const std::string& bus_id,
                  std::chrono::milliseconds timeout = control_timeout);
  ~UsbipConnection();

  /// Control transfers then wait for the turns of `lock_step`, which must outlive this object.
  void wait_in_lock_step(LockStep& lock_step) { lock_step_ = &lock_step; }
  /// After a disconnection, the receiving thread calls `on_disconnect` once with an error sentence.
  void start(std::function<void(const std::string&)> on_disconnect);

  /// The receiving thread calls `on_completion`, which may submit other transfers.
  std::uint32_t submit_in(std::uint8_t endpoint, std::uint32_t length, OnCompletion on_completion);
  std::uint32_t submit_out(std::uint8_t endpoint, std::span<const std::byte> data, OnCompletion on_completion);

  /// Executes a control transfer and waits for its end. Throws Stalled, Disconnected, or, after a time-out, Error.
  std::vector<std::byte> control_in(const Setup& setup);
  void control_out(const Setup& setup, std::span<const std::byte> data);

  /// Cancels the transfer. The transfer completes with -ECONNRESET unless its answer arrives first.
  void unlink(std::uint32_t sequence);

  /// Closes the connection and stops the receiving thread. All open transfers complete with -ENODEV.
  void close();

 private:
  std::uint32_t submit(usbip::Direction direction, std::uint8_t endpoint, const Setup* setup, std::uint32_t length,
                       std::span<const std::byte> data, OnCompletion on_completion);
  Completion control(usbip::Direction direction, const Setup& setup, std::span<const std::byte> data);
  void receive_answers();
  void receive_answer();
  void receive(std::span<std::byte> bytes);

  std::chrono::milliseconds timeout_;  ///< limit for a control transfer
  std::string gone_;                   ///< message after a disconnection
  LockStep* lock_step_ = nullptr;
  Socket socket_;
  std::uint32_t device_ = 0;
  std::mutex mutex_;  ///< guards sending, `sequence_` and `open_`
  std::uint32_t sequence_ = 0;
  OpenTransfers open_;
  bool closed_ = false;
  std::function<void(const std::string&)> on_disconnect_;
  std::thread receiver_;
};

}  // namespace inkwell::device
