// Connects to one USB device through hidapi and libusb, or to a virtual device through USB/IP.
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

/// Synchronizes a program with a virtual board. Each report that the program reads is one turn. In each turn, all
/// waiting calls check their conditions.
class LockStep {
 public:
  virtual ~LockStep() = default;
  /// Returns true if this thread must wait for turns, because another thread reads the reports.
  virtual bool is_in_step() const = 0;
  /// Waits until `is_over` is true in a turn. Returns false if no report arrives within `patience`. Throws
  /// Disconnected.
  virtual bool wait(const std::function<bool()>& is_over, std::chrono::milliseconds patience) = 0;
};

/// Returns the lock step for a program that uses the device in only one thread.
LockStep& one_thread();

struct Endpoint {
  enum class Kind : std::uint8_t { usb, usbip };
  Kind kind;
  std::string serial_number;
  std::string product;
  std::string path;        ///< hidapi path for `usb`, or bus id for `usbip`
  SocketAddress server{};  ///< for `usbip`
  bool is_virtual = false;
  /// Only for virtual boards. If set, the transport requests a report only when the program reads one. The LockStep
  /// object must outlive the transport.
  LockStep* lock_step = nullptr;
  /// Only for virtual boards. The seed makes claims and tickets repeatable.
  std::optional<std::uint64_t> seed = {};
};

/// Returns the arms on USB.
std::vector<Endpoint> find_usb_devices();
/// Returns the arms of a USB/IP server. Throws Error if the server does not answer. The serial numbers are known only
/// after open_transport().
std::vector<Endpoint> find_usbip_devices(const SocketAddress& server);

/// One thread may use the report functions, and another thread may use the scope functions.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Waits for an input report. Returns the report length with the report id, or 0 after a time-out. In lock step, the
  /// call requests a report from the board unless the time-out is 0.
  virtual std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds timeout) = 0;
  /// Does not wait for the device unless many reports are pending.
  virtual void write_report(std::span<const std::byte> report) = 0;
  /// Waits until the device has received all written reports. Returns false after a time-out. The default
  /// implementation assumes that write_report() waits for the device.
  virtual bool wait_until_written([[maybe_unused]] std::chrono::milliseconds timeout) { return true; }
  /// `report[0]` contains the report id. Returns the received length.
  virtual std::size_t get_feature(std::span<std::byte> report) = 0;
  virtual void set_feature(std::span<const std::byte> report) = 0;
  /// Claims the bulk endpoint of the scope for this program. Throws InUse if another program has claimed the endpoint.
  virtual void claim_scope() = 0;
  /// Releases the bulk endpoint. Has no effect if this program has not claimed the endpoint.
  virtual void release_scope() = 0;
  /// Waits for one bulk transfer after claim_scope(). Returns the length of the transfer, or 0 after a time-out. A
  /// reader that is 100 ms late loses no data.
  virtual std::size_t read_bulk(std::span<std::byte> transfer, std::chrono::milliseconds timeout) = 0;
  /// Returns the endpoint with serial number and product name from the device.
  virtual const Endpoint& endpoint() const = 0;
};

std::unique_ptr<Transport> open_transport(const Endpoint& endpoint);

}  // namespace inkwell::device
