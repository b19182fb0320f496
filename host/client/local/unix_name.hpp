// The path of a Unix socket as a system call argument.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>

namespace inkwell::local {

class UnixName {
 public:
  static constexpr std::size_t longest_path = sizeof(sockaddr_un::sun_path) - 1;

  /// Longer paths are truncated, so the caller must check the length of the path.
  explicit UnixName(const std::filesystem::path& path) {
    address_.sun_family = AF_UNIX;
    const std::string text = path.string();
    std::copy_n(text.begin(), std::min(text.size(), longest_path), address_.sun_path);
  }
  const sockaddr* address() const { return reinterpret_cast<const sockaddr*>(&address_); }
  socklen_t size() const { return sizeof address_; }

 private:
  sockaddr_un address_{};
};

}  // namespace inkwell::local
