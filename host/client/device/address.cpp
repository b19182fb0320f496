#include "host/client/device/address.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "host/client/device/arm_names.hpp"
#include "host/client/device/nearest_name.hpp"

namespace inkwell::device {
namespace {

constexpr std::string_view usbip_scheme = "usbip:", board_scheme = "virtual:", own_board = "virtual",
                           board_options = "virtual?";

/// A server may list its arm late, because the firmware connects to USB only after 0.1 s of board time.
constexpr auto start_patience = std::chrono::seconds(2);
constexpr auto look_again = std::chrono::milliseconds(20);

std::string serial_numbers(const std::vector<Endpoint>& endpoints) {
  std::string numbers;
  for (const auto& endpoint : endpoints) numbers += " " + endpoint.serial_number;
  return numbers;
}

struct AddressForm {
  std::string_view name;
};
constexpr AddressForm address_forms[] = {{own_board}, {usbip_scheme}, {board_scheme}, {board_options}};

/// Serial numbers of boards are hexadecimal.
bool is_serial_number(std::string_view text) {
  return std::ranges::all_of(text, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

std::string no_endpoint_message(const Address& address) {
  if (address.kind == Address::Kind::usbip)
    return fmt::format(
        "The USB/IP server at {} exports no arm. Check that its board runs Inkwell's firmware and that its cable is "
        "plugged in.",
        address.server.text());
  if (address.serial_number.empty()) return "No arm was found on USB. Plug in an arm, or use a virtual board.";
  const auto others = find_arms({});
  const std::string others_text =
      others.empty() ? "Plug it in." : "The connected arms are:" + serial_numbers(others) + ".";
  if (!address.name.empty())
    return fmt::format("The arm {} is not plugged in. Its serial number in {} is {}. {}", address.name,
                       arm_names_file().string(), address.serial_number, others_text);
  return fmt::format("No arm with the serial number {} is plugged in. {}", address.serial_number, others_text);
}

std::string no_address_message(const std::string& text) {
  const auto arms = read_arm_names();
  std::vector<AddressForm> names(std::begin(address_forms), std::end(address_forms));
  for (const auto& arm : arms) names.push_back({arm.name});
  const std::string known = arms.empty() ? "No names are known; `inkwell arms bind` adds one."
                                         : fmt::format("Known names: {}.", names_of(arms));
  return fmt::format(
      "`{}` is neither a serial number, a name nor another address.{} {} Give the serial number or the name of an arm, "
      "usbip:HOST:PORT, usbip:unix:PATH or virtual.",
      text, suggestion(names, text), known);
}

Address parse_board_options(std::string_view options) {
  Address address{.kind = Address::Kind::own_board};
  while (!options.empty()) {
    const auto end = std::min(options.find('&'), options.size());
    const std::string_view option = options.substr(0, end);
    options.remove_prefix(std::min(end + 1, options.size()));
    const auto equals = option.find('=');
    const std::string_view name = option.substr(0, equals);
    const std::string_view value = equals == std::string_view::npos ? std::string_view() : option.substr(equals + 1);
    if (name == "seed") {
      std::uint64_t seed = 0;
      const auto [parsed, code] = std::from_chars(value.data(), value.data() + value.size(), seed);
      if (code != std::errc{} || parsed != value.data() + value.size())
        throw BadAddress(
            fmt::format("`{}` is not a seed. Give a whole number from 0 on, as in virtual?seed=7.", value));
      address.seed = seed;
    } else if (name == "arm" && !value.empty()) {
      address.arm = std::string(value);
    } else if (name == "elf" && !value.empty()) {
      address.elf = std::string(value);
    } else {
      throw BadAddress(fmt::format(
          "`{}` is not an option of a virtual board. Give seed=NUMBER, arm=FILE or elf=FILE, with & between "
          "them, as in virtual?seed=7&arm=my_arm.toml.",
          option));
    }
  }
  return address;
}

}  // namespace

SocketAddress parse_socket(std::string_view text) {
  try {
    return local::parse_socket_address(text);
  } catch (const local::BadSocketAddress& error) {
    throw BadAddress(error.what());
  }
}

Address parse_server(std::string_view text) {
  if (text.starts_with(usbip_scheme)) text.remove_prefix(usbip_scheme.size());
  return {.kind = Address::Kind::usbip, .server = parse_socket(text)};
}

Address parse_address(std::string_view text) {
  if (text.starts_with(usbip_scheme)) return parse_server(text);
  if (text == own_board) return {.kind = Address::Kind::own_board};
  if (text.starts_with(board_options)) return parse_board_options(text.substr(board_options.size()));
  if (text.starts_with(board_scheme))
    return {.kind = Address::Kind::own_board, .arm = std::string(text.substr(board_scheme.size()))};
  return {.kind = Address::Kind::usb, .serial_number = std::string(text)};
}

std::string address_of(const Endpoint& endpoint) {
  return endpoint.kind == Endpoint::Kind::usb ? endpoint.serial_number
                                              : fmt::format("{}{}", usbip_scheme, endpoint.server.text());
}

std::vector<Endpoint> find_arms(const Address& address) {
  switch (address.kind) {
    case Address::Kind::own_board: return {};
    case Address::Kind::usbip: return find_usbip_devices(address.server);
    case Address::Kind::usb: break;
  }
  auto endpoints = find_usb_devices();
  if (!address.serial_number.empty())
    std::erase_if(endpoints, [&](const auto& endpoint) { return endpoint.serial_number != address.serial_number; });
  return endpoints;
}

Endpoint find_arm(const Address& address) {
  const auto deadline = std::chrono::steady_clock::now() + start_patience;
  auto endpoints = find_arms(address);
  while (endpoints.empty() && address.kind == Address::Kind::usbip && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(look_again);
    endpoints = find_arms(address);
  }
  if (endpoints.empty() && !is_serial_number(address.serial_number))
    throw BadAddress(no_address_message(address.serial_number));
  if (endpoints.empty()) throw NoDevice(no_endpoint_message(address));
  if (address.kind == Address::Kind::usb && endpoints.size() > 1)
    throw SeveralArms(fmt::format("{} arms are plugged in. Choose one by its serial number:{}.", endpoints.size(),
                                  serial_numbers(endpoints)));
  return endpoints.front();
}

}  // namespace inkwell::device
