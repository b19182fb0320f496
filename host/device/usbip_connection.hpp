// An imported USB/IP device: transfers go out, a thread of its own takes the answers in.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <device/error.hpp>
#include <device/transport.hpp>
#include <usbip/messages.hpp>

#include "socket.hpp"
#include "usb_descriptors.hpp"
#include "usbip_answers.hpp"

namespace inkwell::device {

/// What a USB/IP server exports. Throws Error if nobody or something else answers, or nothing for 3 s.
std::vector<UsbipDevice> list_usbip_devices(const SocketAddress& server);

class UsbipConnection {
 public:
  /// A request takes some milliseconds of board time, but on a busy computer a virtual board's seconds are long.
  static constexpr auto control_timeout = std::chrono::seconds(15);

  using Completion = UsbipCompletion;
  using OnCompletion = OnUsbipCompletion;

  /// Imports the device. Throws Error if it is in use or gone, or as list_usbip_devices does. Call `start` before the
  /// first transfer. A control transfer is taken back after `timeout`.
  UsbipConnection(const SocketAddress& server, const std::string& bus_id,
                  std::chrono::milliseconds timeout = control_timeout);
  ~UsbipConnection();

  /// Control transfers wait in the turns of `lock_step`, which outlives this.
  void wait_in_lock_step(LockStep& lock_step) { lock_step_ = &lock_step; }
  /// `on_disconnect` is called once, from the receiving thread, with a sentence.
  void start(std::function<void(const std::string&)> on_disconnect);

  /// Completions come on the receiving thread, which may submit again from within.
  std::uint32_t submit_in(std::uint8_t endpoint, std::uint32_t length, OnCompletion on_completion);
  std::uint32_t submit_out(std::uint8_t endpoint, std::span<const std::byte> data, OnCompletion on_completion);

  /// Control transfers wait for their end. Throw Stalled, Disconnected, or Error on time-out.
  std::vector<std::byte> control_in(const Setup& setup);
  void control_out(const Setup& setup, std::span<const std::byte> data);

  /// Takes the transfer back. Its completion then comes with -ECONNRESET, or with its answer if that was sooner.
  void unlink(std::uint32_t sequence);

  /// Ends the connection and the receiving thread; open transfers are forgotten.
  void close();

 private:
  std::uint32_t submit(usbip::Direction direction, std::uint8_t endpoint, const Setup* setup, std::uint32_t length,
                       std::span<const std::byte> data, OnCompletion on_completion);
  Completion control(usbip::Direction direction, const Setup& setup, std::span<const std::byte> data);
  void receive_answers();
  void receive_answer();
  void receive(std::span<std::byte> bytes);

  std::chrono::milliseconds timeout_;  ///< of a control transfer
  std::string gone_;                   ///< the sentence for a device that goes away
  LockStep* lock_step_ = nullptr;
  Socket socket_;
  std::uint32_t device_ = 0;
  std::mutex mutex_;  ///< guards sending, the sequence and what is open
  std::uint32_t sequence_ = 0;
  OpenTransfers open_;
  bool closed_ = false;
  std::function<void(const std::string&)> on_disconnect_;
  std::thread receiver_;
};

}  // namespace inkwell::device
