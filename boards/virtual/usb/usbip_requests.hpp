// Parser for the requests of USB/IP clients.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "boards/virtual/usb/urb.hpp"
#include "protocol/usbip/messages.hpp"

namespace inkwell::virtual_board {

/// Bus identifier, bus number and device number of the exported device.
inline constexpr char exported_bus_id[] = "1-1";
inline constexpr std::uint32_t exported_bus_number = 1, exported_device_number = 2;
/// Largest accepted transfer in bytes, equal to the limit of Linux usbfs.
inline constexpr std::uint32_t transfer_maximum = 16u << 20;
/// Largest number of packets in an isochronous transfer, equal to the limit of Linux.
inline constexpr std::uint32_t packets_maximum = 1024;

/// Parses the requests of one client. A request is returned when all its bytes have been received. The functions throw
/// std::runtime_error if a request is invalid. The error text completes the sentence "... because". After an invalid
/// request, no further bytes of the client can be parsed.
class UsbIpRequests {
 public:
  struct ListDevices {};
  struct Import {
    std::string bus_id;
  };
  struct Unlink {
    std::uint32_t sequence;  ///< of the unlink request
    std::uint32_t unlinked_sequence;
  };
  using Operation = std::variant<ListDevices, Import>;
  using Transfer = std::variant<Urb, Unlink>;

  void feed(std::span<const std::byte> bytes);
  /// Returns the next request of a client that has not imported the device.
  std::optional<Operation> take_operation();
  /// Returns the next request of a client that has imported the device. An OUT transfer contains all its data, and an
  /// isochronous transfer contains all its packets.
  std::optional<Transfer> take_transfer();

 private:
  void check_version() const;
  std::span<const std::byte> rest() const { return std::span(received_).subspan(consumed_); }

  std::vector<std::byte> received_;
  std::size_t consumed_ = 0;
};

}  // namespace inkwell::virtual_board
