#include "host/client/local/socket_address.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <cerrno>

#include <fmt/format.h>

#include "host/client/local/unix_name.hpp"

namespace inkwell::local {

std::string SocketAddress::text() const {
  return is_unix() ? fmt::format("{}{}", unix_scheme, path.string()) : fmt::format("{}:{}", host, port);
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
  int result = -1;
  do result = ::connect(socket.number(), name.address(), name.size());
  while (result != 0 && errno == EINTR);  // a connection to a Unix socket can be retried after an interruption
  if (result == 0) return socket;
  const int reason = errno;
  socket = Descriptor();
  errno = reason;
  return socket;
}

}  // namespace inkwell::local
