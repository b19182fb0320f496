// Where an arm is, as people and programs write it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <device/transport.hpp>

namespace inkwell::device {

/// A text that is no address.
class BadAddress : public Error {
 public:
  using Error::Error;
};

/// No arm is there that is meant.
class NoDevice : public Error {
 public:
  using Error::Error;
};

/// More than one arm is there and none was named. `what()` lists their serial numbers.
class SeveralArms : public NoDevice {
 public:
  using NoDevice::NoDevice;
};

/// Written as one of
///
///     (nothing)        the only arm on USB
///     NUMBER           the arm on USB that has this serial number
///     usbip:HOST:PORT  the arm of a USB/IP server, such as a virtual board that runs already
///     usbip:unix:PATH  the same at a Unix socket
///     virtual          a virtual board that is started for it
///     virtual:FILE     the same, with the arm that FILE describes
///     virtual?seed=7&arm=FILE&elf=FILE
///                      the same, with any of these: the seed of all noise, an arm, the firmware to run
struct Address {
  enum class Kind : std::uint8_t { usb, usbip, own_board };
  Kind kind = Kind::usb;
  std::string serial_number{};          ///< for `usb`; empty for the only one
  SocketAddress server{};               ///< for `usbip`
  std::filesystem::path arm{};          ///< for `own_board`; empty for the Omni
  std::filesystem::path elf{};          ///< for `own_board`; empty for the firmware of this installation
  std::optional<std::uint64_t> seed{};  ///< for `own_board`
};

/// Throws BadAddress.
Address parse_address(std::string_view text);
/// Of a server: HOST:PORT, PORT alone on this computer, or unix:PATH. Throws BadAddress.
SocketAddress parse_socket(std::string_view text);
/// The arm of the USB/IP server at such an address. Throws BadAddress.
Address parse_server(std::string_view text);
/// Leads back to a device that was found, once it was opened.
std::string address_of(const Endpoint& endpoint);

/// The arms that the address may mean; none for a board that is not started yet. Throws Error if a server does not
/// answer.
std::vector<Endpoint> find_arms(const Address& address);
/// The one that it means. Waits two seconds for the arm of a server that answers. Throws NoDevice, as SeveralArms if
/// the address does not say which.
Endpoint find_arm(const Address& address);

}  // namespace inkwell::device
