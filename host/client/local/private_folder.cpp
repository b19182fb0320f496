#include "host/client/local/private_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "host/client/local/socket_address.hpp"

#include "host/client/local/folder_rights.hpp"
#include "host/client/local/unix_name.hpp"

namespace inkwell::local {
namespace {

constexpr char pattern[] = "/inkwell-XXXXXX";
constexpr std::size_t longest_name = 16;  ///< name of a socket in the folder, with the slash

/// Returns true if other users cannot change the folder and the folder is suitable for sockets.
bool is_suitable(const char* folder) {
  if (folder == nullptr || folder[0] != '/' || !only_owner_changes(folder)) return false;
  try {
    unix_socket(std::string(unix_scheme) + folder);
  } catch (const BadSocketAddress&) {
    return false;
  }
  return std::strlen(folder) + sizeof pattern + longest_name <= UnixName::longest_path;
}

}  // namespace

PrivateFolder PrivateFolder::for_files() {
  std::error_code ignored;
  const std::string parent = std::filesystem::temp_directory_path(ignored).string();
  return PrivateFolder(std::array{parent});
}

PrivateFolder PrivateFolder::for_sockets() {
  std::vector<std::string> parents;
  for (const char* parent : std::array<const char*, 3>{std::getenv("XDG_RUNTIME_DIR"), std::getenv("TMPDIR"), "/tmp"})
    if (is_suitable(parent)) parents.emplace_back(parent);
  return PrivateFolder(parents);
}

PrivateFolder::PrivateFolder(std::span<const std::string> parents) {
  int reason = ENOENT;
  for (const std::string& parent : parents) {
    std::string path = parent + pattern;
    if (::mkdtemp(path.data()) != nullptr) {  // with mode 0700
      path_ = path;
      return;
    }
    reason = errno;
  }
  throw std::runtime_error(
      fmt::format("A private folder cannot be created in {}: {}. Set TMPDIR to one of your folders.",
                  parents.empty() ? "/tmp" : parents.back(), std::strerror(reason)));
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace inkwell::local
