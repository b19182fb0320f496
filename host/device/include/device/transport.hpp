// The way to one USB device: to a real one through hidapi and libusb, to a virtual one through USB/IP.
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

#include <device/error.hpp>
#include <device/socket_address.hpp>

namespace inkwell::device {

/// The calls of a program that is in lock step with a virtual board: each report that the program reads is a turn, and
/// the conditions of waiting calls are checked once per turn.
class LockStep {
 public:
  virtual ~LockStep() = default;
  /// Whether this thread's calls have to wait like this: another thread reads reports.
  virtual bool is_in_step() const = 0;
  /// Waits until `is_over` holds in a turn; false if no report comes for this long. Throws Disconnected.
  virtual bool wait(const std::function<bool()>& is_over, std::chrono::milliseconds patience) = 0;
};

/// Of a program that uses the device in one thread.
LockStep& one_thread();

/// Where a device is.
struct Endpoint {
  enum class Kind : std::uint8_t { usb, usbip };
  Kind kind;
  std::string serial_number;
  std::string product;
  std::string path;         ///< hidapi's path for `usb`, bus id for `usbip`
  SocketAddress server{};   ///< for `usbip`
  bool is_virtual = false;  ///< a virtual board, so what comes from it is a simulation
  /// For a virtual board: asks for one report at a time, when it is read. Outlives the transport.
  LockStep* lock_step = nullptr;
  /// For a virtual board: the numbers that are random otherwise follow from this, so that a run can be repeated.
  std::optional<std::uint64_t> seed = {};
};

/// The arms on this computer's USB.
std::vector<Endpoint> find_usb_devices();
/// The arms exported by a USB/IP server such as a virtual board. Throws Error if it does not answer. Their
/// serial numbers are known only after open_transport, because a USB/IP list of devices does not hold them.
std::vector<Endpoint> find_usbip_devices(const SocketAddress& server);

/// Raw reports and bulk data. Calls may come from two threads: one for reports, one for the bulk stream.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Waits for an input report. Returns its length with the report id in front, 0 on time-out. In lock step this asks
  /// the board for the report, except with a time-out of 0.
  virtual std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds timeout) = 0;
  /// Returns before the device has the report, unless many are under way.
  virtual void write_report(std::span<const std::byte> report) = 0;
  /// Waits until the device has every report that was written; false on time-out. The next report then does not queue
  /// behind others. The default is for a transport whose write_report() waits for this itself.
  virtual bool wait_until_written([[maybe_unused]] std::chrono::milliseconds timeout) { return true; }
  /// `report[0]` holds the report id. Returns the length received.
  virtual std::size_t get_feature(std::span<std::byte> report) = 0;
  virtual void set_feature(std::span<const std::byte> report) = 0;
  /// Makes the scope's bulk stream this program's own; only one program can have it. Throws InUse if another has.
  virtual void claim_scope() = 0;
  /// Another program may have the stream from now on. Nothing if it is not this program's.
  virtual void release_scope() = 0;
  /// Waits for one bulk transfer of the scope; none come before it is claimed. Returns its length, 0 on time-out.
  /// Enough transfers are kept under way that a reader who is late by 100 ms loses nothing.
  virtual std::size_t read_bulk(std::span<std::byte> transfer, std::chrono::milliseconds timeout) = 0;
  /// Where this leads, with the serial number and product name that the device told.
  virtual const Endpoint& endpoint() const = 0;
};

std::unique_ptr<Transport> open_transport(const Endpoint& endpoint);

}  // namespace inkwell::device
