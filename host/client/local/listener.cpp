#include "host/client/local/listener.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "host/client/local/folder_rights.hpp"
#include "host/client/local/interruption.hpp"
#include "host/client/local/unix_name.hpp"

namespace inkwell::local {
namespace {

namespace fs = std::filesystem;

constexpr int waiting_clients = 16;

std::runtime_error refusal(const SocketAddress& where, std::string_view option, std::string_view reason) {
  return std::runtime_error(fmt::format("{}: {} cannot be used: {}.", option, where.text(), reason));
}

/// Checks that other users cannot replace the socket.
void check_folder(const fs::path& folder, const SocketAddress& where, std::string_view option) {
  std::error_code code;
  if (!fs::is_directory(folder, code))
    throw refusal(where, option, "its folder does not exist. Create the folder, or choose another one");
  if (!only_owner_changes(folder))
    throw refusal(where, option, "other users may change its folder. Choose a folder that only you can write");
}

/// Serializes programs that start at the same time. Closing the descriptor releases the lock. If another user locks a
/// shared folder permanently, the start is delayed by one second.
Descriptor lock_folder(const fs::path& folder) {
  Descriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  constexpr int tries = 100;
  for (int i = 0; i < tries && ::flock(file.number(), LOCK_EX | LOCK_NB) != 0; ++i) ::usleep(10'000);
  return file;
}

/// Removes the socket of a terminated program. All other files stay.
void remove_stale_socket(const SocketAddress& where, std::string_view option) {
  struct stat status {};
  if (::lstat(where.path.c_str(), &status) != 0) return;
  if (!S_ISSOCK(status.st_mode))
    throw refusal(where, option, "there is a file that is not a socket. Choose another path");
  if (status.st_uid != ::geteuid())
    throw refusal(where, option, "there is a socket of another user. Choose another path");
  if (connect_to(where.path).is_open() || errno != ECONNREFUSED)
    throw refusal(where, option, "another program listens there. Choose another path, or close that program");
  ::unlink(where.path.c_str());
}

constexpr std::string_view this_computer_ipv6 = "::1";

int family_of(const SocketAddress& where) {
  return where.is_unix() ? AF_UNIX : where.host == this_computer_ipv6 ? AF_INET6 : AF_INET;
}

/// The address of a port of this computer as a system call argument.
union PortName {
  sockaddr any;
  sockaddr_in ipv4;
  sockaddr_in6 ipv6;
};

}  // namespace

Listener::Listener(SocketAddress where, std::string_view option)
    : address_(std::move(where)), socket_(::socket(family_of(address_), SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (!socket_.is_open()) throw refusal(address_, option, std::strerror(errno));
  address_.is_unix() ? listen_on_path(option) : listen_on_port(option);
}

Listener::~Listener() {
  if (!address_.is_unix()) return;
  struct stat status {};
  const bool is_there = ::lstat(address_.path.c_str(), &status) == 0;
  if (is_there && status.st_dev == device_ && status.st_ino == inode_) ::unlink(address_.path.c_str());
}

void Listener::listen_on_port(std::string_view option) {
  const bool is_ipv6 = family_of(address_) == AF_INET6;
  if (!is_ipv6) address_.host = this_computer;
  const int on = 1;
  ::setsockopt(socket_.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  PortName name{};
  if (is_ipv6)
    name.ipv6 = {.sin6_family = AF_INET6,
                 .sin6_port = htons(address_.port),
                 .sin6_flowinfo = 0,
                 .sin6_addr = in6addr_loopback,
                 .sin6_scope_id = 0};
  else
    name.ipv4 = {.sin_family = AF_INET,
                 .sin_port = htons(address_.port),
                 .sin_addr = {.s_addr = htonl(INADDR_LOOPBACK)},
                 .sin_zero = {}};
  socklen_t size = is_ipv6 ? sizeof name.ipv6 : sizeof name.ipv4;
  if (::bind(socket_.number(), &name.any, size) != 0 || ::listen(socket_.number(), waiting_clients) != 0) {
    const std::string reason =
        errno == EADDRINUSE ? std::string("another program listens there") : std::string(std::strerror(errno));
    throw refusal(address_, option, reason + ". Choose another port, or 0 for any free one");
  }
  ::getsockname(socket_.number(), &name.any, &size);
  address_.port = ntohs(is_ipv6 ? name.ipv6.sin6_port : name.ipv4.sin_port);
}

void Listener::listen_on_path(std::string_view option) {
  // The path is absolute, because the working folder may change before the socket is removed.
  address_.path = fs::absolute(address_.path);
  if (address_.path.string().size() > UnixName::longest_path)
    throw refusal(address_, option, "the path is too long for a socket. Choose a shorter one");
  const fs::path folder = address_.path.parent_path();
  check_folder(folder, address_, option);
  const Descriptor folder_lock = lock_folder(folder);
  remove_stale_socket(address_, option);
  const UnixName name(address_.path);
  // Linux applies the mode of the socket to the file, so other users can never connect.
  struct stat status {};
  if (::fchmod(socket_.number(), S_IRUSR | S_IWUSR) != 0 || ::bind(socket_.number(), name.address(), name.size()) != 0)
    throw refusal(address_, option, std::strerror(errno));
  if (::lstat(address_.path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode) || (status.st_mode & 0177) != 0)
    throw refusal(address_, option, "its mode is not 0600. Choose a folder of another file system");
  device_ = status.st_dev;
  inode_ = status.st_ino;
  if (::listen(socket_.number(), waiting_clients) != 0) throw refusal(address_, option, std::strerror(errno));
}

bool send_all(int socket, std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = repeat_interrupted([&] { return ::send(socket, text.data(), text.size(), MSG_NOSIGNAL); });
    if (sent <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

}  // namespace inkwell::local
