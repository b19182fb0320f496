#include "boards/virtual/program/port_option.hpp"

#include <charconv>
#include <stdexcept>

#include <fmt/format.h>

namespace inkwell::virtual_board {

PortOption PortOption::of(const std::string& text) {
  if (text == local::unix_scheme) return {.is_private = true};
  if (text.starts_with(local::unix_scheme)) {
    try {
      return {.address = local::unix_socket(text)};
    } catch (const local::BadSocketAddress& error) {
      throw std::invalid_argument(error.what());
    }
  }
  PortOption option;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, option.address.port);
  if (number.ec == std::errc{} && number.ptr == end) return option;
  try {
    option.address = local::parse_socket_address(text);
  } catch (const local::BadSocketAddress&) {
    option.address = {};
  }
  if (option.address.host == "localhost") option.address.host = local::this_computer;
  if (option.address.host == local::this_computer || option.address.host == "::1") return option;
  throw std::invalid_argument(
      fmt::format("\"{}\" is not a port of this computer. Write 0 to 65535 for a TCP port, [::1]:PORT for a port of "
                  "IPv6, or unix:PATH for a Unix socket.",
                  text));
}

std::string announced(const local::SocketAddress& address) {
  return address.is_unix() || address.host != local::this_computer ? address.text() : std::to_string(address.port);
}

local::SocketAddress PrivateSockets::address_of(const PortOption& option, const std::string& name) {
  if (!option.is_private) return option.address;
  if (!folder_) folder_.emplace(local::PrivateFolder::for_sockets());
  return {.path = folder_->path() / name};
}

}  // namespace inkwell::virtual_board
