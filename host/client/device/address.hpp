// Addresses of arms, as users and programs write them.
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

/// More than one arm is connected, and the address does not select one. `what()` lists the serial numbers of the
/// connected arms.
class SeveralArms : public NoDevice {
 public:
  using NoDevice::NoDevice;
};

/// Forms of an address:
///
///     (nothing)          The only arm on USB.
///     `NUMBER`           The arm on USB with this serial number.
///     `usbip:HOST:PORT`  The arm of a USB/IP server, such as a running virtual board.
///     `usbip:unix:PATH`  The arm of a USB/IP server at a Unix socket.
///     `virtual`          A new virtual board.
///     `virtual:FILE`     A new virtual board with the arm description FILE.
///     `virtual?seed=7&arm=FILE&elf=FILE`
///                        A new virtual board with this noise seed, arm description and firmware, in any combination.
struct Address {
  enum class Kind : std::uint8_t { usb, usbip, own_board };
  Kind kind = Kind::usb;
  std::string serial_number{};          ///< for `usb`; empty: the only arm
  SocketAddress server{};               ///< for `usbip`
  std::filesystem::path arm{};          ///< for `own_board`; empty: the Omni
  std::filesystem::path elf{};          ///< for `own_board`; empty: the firmware of this installation
  std::optional<std::uint64_t> seed{};  ///< for `own_board`
};

/// Throws BadAddress.
Address parse_address(std::string_view text);
/// Parses a server address: HOST:PORT, PORT on this computer, or unix:PATH. Throws BadAddress.
SocketAddress parse_socket(std::string_view text);
/// The address of the arm at a USB/IP server. Throws BadAddress.
Address parse_server(std::string_view text);
/// The address of an endpoint. Open the device before this call, because the serial number is unknown until then.
std::string address_of(const Endpoint& endpoint);

/// Returns the arms that match the address. Returns an empty list for a virtual board that is not started yet. Throws
/// Error if a server does not answer.
std::vector<Endpoint> find_arms(const Address& address);
/// Returns the only arm that matches the address. If a server answers, waits up to two seconds until the server lists
/// the arm. Throws NoDevice, or SeveralArms if several arms match.
Endpoint find_arm(const Address& address);

}  // namespace inkwell::device
