#include "host/client/local/socket_address.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>

#include <fmt/format.h>

#include "host/client/local/interruption.hpp"
#include "host/client/local/unix_name.hpp"

namespace inkwell::local {

std::string SocketAddress::text() const {
  if (is_unix()) return fmt::format("{}{}", unix_scheme, path.string());
  return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port) : fmt::format("[{}]:{}", host, port);
}

SocketAddress parse_socket_address(std::string_view text) {
  if (text.starts_with(unix_scheme)) return unix_socket(text);
  const auto colon = text.rfind(':');
  const bool names_host = colon != std::string_view::npos;
  std::string_view host = names_host && colon > 0 ? text.substr(0, colon) : this_computer;
  const std::string_view digits = names_host ? text.substr(colon + 1) : text;
  std::uint16_t port = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  const bool has_brackets = host.starts_with('[') && host.ends_with(']');
  if (has_brackets) host = host.substr(1, host.size() - 2);
  // Without brackets, the port of an IPv6 address would be ambiguous.
  const bool is_host = !host.empty() && host.find_first_of(has_brackets ? "[]" : "[]:") == std::string_view::npos;
  if (code != std::errc{} || end != digits.data() + digits.size() || port == 0 || !is_host)
    throw BadSocketAddress(
        fmt::format("`{}` is not the address of a server. Give HOST:PORT, for example 127.0.0.1:3240 or [::1]:3240, or "
                    "unix:PATH.",
                    text));
  return {.host = std::string(host), .port = port};
}

SocketAddress unix_socket(std::string_view text) {
  const std::string path(text.substr(unix_scheme.size()));
  if (path.empty()) throw BadSocketAddress(fmt::format("`{}` has no path. Write unix:PATH.", text));
  const bool is_printable =
      std::ranges::none_of(path, [](unsigned char letter) { return letter <= ' ' || letter == 0x7F; });
  if (!is_printable)
    throw BadSocketAddress(fmt::format("The path of a socket has a blank or a control character. Choose another one."));
  if (path.size() > UnixName::longest_path)
    throw BadSocketAddress(
        fmt::format("{} is too long for the path of a socket, which may have {} characters. Choose a "
                    "shorter one.",
                    path, UnixName::longest_path));
  return {.path = path};
}

Descriptor connect_to(const std::filesystem::path& path) {
  const UnixName name(path);
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!socket.is_open()) return socket;
  // An interrupted connect() of a Unix socket has no effect, so it can be repeated.
  if (repeat_interrupted([&] { return ::connect(socket.number(), name.address(), name.size()); }) == 0) return socket;
  const int reason = errno;
  socket = Descriptor();
  errno = reason;
  return socket;
}

}  // namespace inkwell::local
