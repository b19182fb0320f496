// The connection to one USB device: through hidapi and libusb to a real device, through USB/IP to a virtual device.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/client/device/error.hpp"
#include "host/client/device/socket_address.hpp"

namespace inkwell::device {

/// Lock step between a program and a virtual board, for calls that wait. Each report that the program reads is a turn.
/// The conditions of waiting calls are checked once per turn.
class LockStep {
 public:
  virtual ~LockStep() = default;
  /// Whether calls of this thread must wait for turns, because another thread reads the reports.
  virtual bool is_in_step() const = 0;
  /// Waits until `is_over` is true in a turn; false if no report arrives for `patience`. Throws Disconnected.
  virtual bool wait(const std::function<bool()>& is_over, std::chrono::milliseconds patience) = 0;
};

/// Lock step for a program that uses the device in one thread.
LockStep& one_thread();

/// The location of a device.
struct Endpoint {
  enum class Kind : std::uint8_t { usb, usbip };
  Kind kind;
  std::string serial_number;
  std::string product;
  std::string path;         ///< hidapi's path for `usb`, bus id for `usbip`
  SocketAddress server{};   ///< for `usbip`
  bool is_virtual = false;  ///< true: a virtual board, so its data are simulated
  /// Only for a virtual board. Each report is then requested when the program reads it. The LockStep object must
  /// outlive the transport.
  LockStep* lock_step = nullptr;
  /// Seed of numbers that are otherwise random, for repeatable runs. Only for a virtual board.
  std::optional<std::uint64_t> seed = {};
};

/// Returns the arms that are connected to this computer by USB.
std::vector<Endpoint> find_usb_devices();
/// The arms exported by a USB/IP server such as a virtual board. Throws Error if the server does not answer. Serial
/// numbers are known only after open_transport(), because USB/IP device lists do not contain them.
std::vector<Endpoint> find_usbip_devices(const SocketAddress& server);

/// Raw reports and bulk data. Two threads may use this class: one thread for reports and one thread for the bulk
/// stream.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Waits for an input report. Returns the report length including the leading report id, or 0 on time-out. In lock
  /// step the call requests the report from the board, unless the time-out is 0.
  virtual std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds timeout) = 0;
  /// Returns without waiting for the device, unless many reports are pending.
  virtual void write_report(std::span<const std::byte> report) = 0;
  /// Waits until the device has received every written report; false on time-out. The next report is then sent without
  /// delay. The default implementation is for a transport whose write_report() waits for the device.
  virtual bool wait_until_written([[maybe_unused]] std::chrono::milliseconds timeout) { return true; }
  /// `report[0]` is the report id. Returns the received length.
  virtual std::size_t get_feature(std::span<std::byte> report) = 0;
  virtual void set_feature(std::span<const std::byte> report) = 0;
  /// Reserves the scope's bulk stream for this program. Throws InUse if another program has reserved the stream.
  virtual void claim_scope() = 0;
  /// Releases the stream for other programs. Has no effect if this program has not reserved the stream.
  virtual void release_scope() = 0;
  /// Waits for one bulk transfer of the scope, which must be claimed. Returns the length of the transfer, or 0 on
  /// time-out. Enough transfers are pending to prevent data loss if the reader is 100 ms late.
  virtual std::size_t read_bulk(std::span<std::byte> transfer, std::chrono::milliseconds timeout) = 0;
  /// The endpoint, with the serial number and product name that the device reported.
  virtual const Endpoint& endpoint() const = 0;
};

std::unique_ptr<Transport> open_transport(const Endpoint& endpoint);

}  // namespace inkwell::device
