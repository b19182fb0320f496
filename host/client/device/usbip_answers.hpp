// Parses the answers of a USB/IP server.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "host/client/device/error.hpp"
#include "protocol/usbip/messages.hpp"

namespace inkwell::device {

/// Fills the span with received bytes. Throws Error if the bytes do not arrive.
using ReceiveBytes = std::function<void(std::span<std::byte>)>;

template <class Message>
Message receive_message(const ReceiveBytes& receive) {
  Message message;
  receive(std::as_writable_bytes(std::span(&message, 1)));
  return message;
}

struct UsbipDevice {
  std::string path;  ///< device path on the server
  std::string bus_id;
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
};

/// A server cannot make this program receive indefinitely, because a longer list is refused.
inline constexpr std::uint32_t listed_devices_maximum = 256;
/// Receives the device list. Throws Error if the peer is not a USB/IP server.
std::vector<UsbipDevice> receive_device_list(const ReceiveBytes& receive);

/// Receives the answer to an import request. Returns the device id for transfers, or std::nullopt if the device is not
/// available. Throws Error if the peer is not a USB/IP server.
std::optional<std::uint32_t> receive_import(const ReceiveBytes& receive);

struct UsbipCompletion {
  std::int32_t status = 0;      ///< 0 or a negative errno
  std::uint32_t length = 0;     ///< transferred bytes
  std::vector<std::byte> data;  ///< for an IN transfer
};
using OnUsbipCompletion = std::function<void(UsbipCompletion)>;

struct UsbipTransfer {
  usbip::Direction direction;
  std::uint32_t length;
  OnUsbipCompletion on_completion;
};

/// Transfers without an answer. Not thread-safe.
class OpenTransfers {
 public:
  void add(std::uint32_t sequence, UsbipTransfer transfer) { transfers_.emplace(sequence, std::move(transfer)); }
  bool contains(std::uint32_t sequence) const { return transfers_.contains(sequence); }
  /// The transfer stays open until the server has answered the unlink request, because its own answer may already be on
  /// the way.
  void unlink(std::uint32_t unlink_sequence, std::uint32_t sequence) { unlinks_.emplace(unlink_sequence, sequence); }

  /// Returns the number of data bytes that follow the answer. Throws Disconnected if no open transfer belongs to the
  /// answer.
  std::size_t data_length_of(const usbip::ReturnSubmit& answer) const;
  struct Ended {
    OnUsbipCompletion on_completion;
    UsbipCompletion completion;
  };
  std::optional<Ended> take(const usbip::ReturnSubmit& answer, std::vector<std::byte> data);
  std::vector<UsbipTransfer> take_all();

 private:
  std::unordered_map<std::uint32_t, UsbipTransfer> transfers_;
  std::unordered_map<std::uint32_t, std::uint32_t> unlinks_;  ///< maps an unlink sequence to its transfer sequence
};

}  // namespace inkwell::device
