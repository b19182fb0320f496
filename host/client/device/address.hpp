// Parses the addresses of arms.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/transport.hpp"

namespace inkwell::device {

/// The text is not an address.
class BadAddress : public Error {
 public:
  using Error::Error;
};

/// No arm with this address is connected.
class NoDevice : public Error {
 public:
  using Error::Error;
};

/// More than one connected arm matches the address. `what()` lists the serial numbers of these arms.
class SeveralArms : public NoDevice {
 public:
  using NoDevice::NoDevice;
};

/// Forms of an address:
///
///     (nothing)          The only arm on USB.
///     `NUMBER`           An arm on USB, selected by serial number.
///     `usbip:HOST:PORT`  An arm on a USB/IP server (TCP). An IPv6 address is in brackets: `usbip:[::1]:PORT`.
///     `usbip:unix:PATH`  An arm on a USB/IP server (Unix socket).
///     `virtual`          A new virtual board.
///     `virtual:FILE`     A new virtual board with the arm description FILE.
///     `virtual?seed=7&arm=FILE&elf=FILE`
///                        A new virtual board with noise seed, arm description and firmware. All three are optional.
struct Address {
  enum class Kind : std::uint8_t { usb, usbip, own_board };
  Kind kind = Kind::usb;
  std::string serial_number{};             ///< for `usb`; empty: the only arm
  SocketAddress server{};                  ///< for `usbip`
  std::filesystem::path arm{};             ///< for `own_board`; empty: the Omni
  std::filesystem::path elf{};             ///< for `own_board`; empty: the firmware of this installation
  std::optional<std::uint64_t> seed{};     ///< for `own_board`
  std::string name{};                      ///< if the user selected the arm by name (arm_names.hpp), otherwise empty
  std::optional<SocketAddress> control{};  ///< control socket of a named virtual board
};

/// Throws BadAddress.
Address parse_address(std::string_view text);
/// Parses HOST:PORT, [IPV6]:PORT, PORT (on this computer) or unix:PATH. Throws BadAddress.
SocketAddress parse_socket(std::string_view text);
/// Parses the address of a server, with or without `usbip:` in front. Throws BadAddress.
Address parse_server(std::string_view text);
/// Returns the address of an endpoint. The serial number is known only after the device was opened.
std::string address_of(const Endpoint& endpoint);

/// Returns the arms that match the address. Returns an empty list if the address demands a new virtual board. Throws
/// Error if a server does not answer.
std::vector<Endpoint> find_arms(const Address& address);
/// Returns the only arm that matches the address. Waits up to two seconds for the arm of a server. Throws NoDevice, or
/// SeveralArms if several arms match.
Endpoint find_arm(const Address& address);

}  // namespace inkwell::device
