#include "boards/virtual/usb/client_name.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <system_error>

#include "host/client/local/process_name.hpp"

namespace inkwell::virtual_board {

namespace {

namespace fs = std::filesystem;

/// Returns the /proc link target of the socket with the local port `port`. The result is empty if the socket does not
/// exist.
std::string link_of_socket(std::uint16_t port) {
  std::ostringstream address;
  address << "0100007F:" << std::uppercase << std::hex << std::setw(4) << std::setfill('0') << port;
  std::ifstream table("/proc/net/tcp");
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string number, local, ignored, inode;
    words >> number >> local;
    for (int i = 0; i < 7; ++i) words >> ignored;
    // The list may still contain a closed connection of this port; a closed connection has the inode 0.
    const bool is_open = words >> inode && inode != "0";
    if (is_open && local == address.str()) return "socket:[" + inode + "]";
  }
  return {};
}

bool has_open(const fs::path& process, const std::string& link) {
  std::error_code error;  // set for processes that have ended or belong to another user
  for (fs::directory_iterator file(process / "fd", error), end; !error && file != end; file.increment(error)) {
    std::error_code unreadable;
    if (fs::read_symlink(*file, unreadable) == link) return true;
  }
  return false;
}

}  // namespace

Peer peer_of(int socket) {
  ucred credentials{};
  socklen_t length = sizeof credentials;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &credentials, &length) == 0 && credentials.pid > 0)
    return {.process = credentials.pid};
  sockaddr_in address{};
  length = sizeof address;
  ::getpeername(socket, reinterpret_cast<sockaddr*>(&address), &length);
  return {.port = ntohs(address.sin_port)};
}

std::string client_name(Peer peer) {
  if (peer.process > 0) return local::name_of_process(peer.process);
  const std::string link = link_of_socket(peer.port);
  std::error_code error;
  for (fs::directory_iterator process("/proc", error), end; !link.empty() && !error && process != end;
       process.increment(error)) {
    const std::string number = process->path().filename();
    if (number.find_first_not_of("0123456789") == std::string::npos && has_open(process->path(), link))
      return local::name_of_process(static_cast<pid_t>(std::stol(number)));
  }
  return "the client with port " + std::to_string(peer.port);
}

}  // namespace inkwell::virtual_board
