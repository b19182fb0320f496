// What a USB/IP server answers, made sense of, wherever its bytes come from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <device/error.hpp>
#include <usbip/messages.hpp>

namespace inkwell::device {

/// Fills the bytes with what the server sent next; throws Error if that does not come.
using ReceiveBytes = std::function<void(std::span<std::byte>)>;

template <class Message>
Message receive_message(const ReceiveBytes& receive) {
  Message message;
  receive(std::as_writable_bytes(std::span(&message, 1)));
  return message;
}

struct UsbipDevice {
  std::string path;  ///< of the device on the server
  std::string bus_id;
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
};

/// A server that lists more is refused, so that it cannot make this program receive for ever.
inline constexpr std::uint32_t listed_devices_maximum = 256;
/// The answer to a request for the list. Throws Error if it is of something else than a USB/IP server.
std::vector<UsbipDevice> receive_device_list(const ReceiveBytes& receive);

/// The answer to an import: what transfers call the device, or none if it cannot be had. Throws Error as above.
std::optional<std::uint32_t> receive_import(const ReceiveBytes& receive);

struct UsbipCompletion {
  std::int32_t status = 0;      ///< 0 or a negative errno
  std::uint32_t length = 0;     ///< bytes that were transferred
  std::vector<std::byte> data;  ///< of an IN transfer
};
using OnUsbipCompletion = std::function<void(UsbipCompletion)>;

struct UsbipTransfer {
  usbip::Direction direction;
  std::uint32_t length;
  OnUsbipCompletion on_completion;
};

/// The transfers that were asked for and not answered yet. Not for use by two threads at once.
class OpenTransfers {
 public:
  void add(std::uint32_t sequence, UsbipTransfer transfer) { transfers_.emplace(sequence, std::move(transfer)); }
  bool contains(std::uint32_t sequence) const { return transfers_.contains(sequence); }
  /// The server may have sent its answer already, so the transfer stays until the unlink is answered.
  void unlink(std::uint32_t unlink_sequence, std::uint32_t sequence) { unlinks_.emplace(unlink_sequence, sequence); }

  /// How many bytes of data follow an answer. Throws Disconnected for an answer to what was not asked for.
  std::size_t data_length_of(const usbip::ReturnSubmit& answer) const;
  /// Once they are there: what an answer says of the transfer that it ends, or none if it ends nothing.
  struct Ended {
    OnUsbipCompletion on_completion;
    UsbipCompletion completion;
  };
  std::optional<Ended> take(const usbip::ReturnSubmit& answer, std::vector<std::byte> data);
  /// All that are left.
  std::vector<UsbipTransfer> take_all();

 private:
  std::unordered_map<std::uint32_t, UsbipTransfer> transfers_;
  std::unordered_map<std::uint32_t, std::uint32_t> unlinks_;  ///< sequence of the unlink to that of its transfer
};

}  // namespace inkwell::device
