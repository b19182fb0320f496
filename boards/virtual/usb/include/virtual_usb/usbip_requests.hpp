// What clients ask of the USB/IP server, found in the bytes that they send.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <usbip/messages.hpp>
#include <virtual_usb/urb.hpp>

namespace inkwell::virtual_board {

/// What the server calls the one device that it exports.
inline constexpr char exported_bus_id[] = "1-1";
inline constexpr std::uint32_t exported_bus_number = 1, exported_device_number = 2;
/// Longest transfer that is accepted, that of Linux' usbfs.
inline constexpr std::uint32_t transfer_maximum = 16u << 20;
/// Most packets of an isochronous transfer; Linux sends no more.
inline constexpr std::uint32_t packets_maximum = 1024;

/// The requests of one client. Each is taken once it is there whole. What makes no sense throws std::runtime_error with
/// what is wrong with the client, "because ..."; nothing more can be found in its bytes then.
class UsbIpRequests {
 public:
  struct ListDevices {};
  struct Import {
    std::string bus_id;
  };
  struct Unlink {
    std::uint32_t sequence;  ///< of the request itself
    std::uint32_t unlinked_sequence;
  };
  using Operation = std::variant<ListDevices, Import>;
  using Transfer = std::variant<Urb, Unlink>;

  void feed(std::span<const std::byte> bytes);
  /// Of a client that has imported nothing.
  std::optional<Operation> take_operation();
  /// Of one that has imported the device. An OUT transfer has all its data, an isochronous one all its packets.
  std::optional<Transfer> take_transfer();

 private:
  void check_version() const;
  std::span<const std::byte> rest() const { return std::span(received_).subspan(consumed_); }

  std::vector<std::byte> received_;
  std::size_t consumed_ = 0;
};

}  // namespace inkwell::virtual_board
