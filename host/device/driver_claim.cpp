#include <device/driver_claim.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include <device/error.hpp>

namespace inkwell::device {
namespace {

std::string own_name() {
  std::string name;
  std::getline(std::ifstream("/proc/self/comm"), name);
  return fmt::format("{} (process {})", name, getpid());
}

/// Another user's file can be opened but, in a folder for all, not created anew.
int open_or_create(const std::string& path) {
  const int existing = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (existing >= 0) return existing;
  const int created = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (created >= 0) fchmod(created, 0666);  // whatever the user's mask: the next user drives the same arm
  return created;
}

}  // namespace

DriverClaim::DriverClaim(const std::string& serial_number) {
  const auto path = std::filesystem::temp_directory_path() / fmt::format("inkwell-{}.driver", serial_number);
  file_ = open_or_create(path.string());
  if (file_ < 0)
    throw Error(fmt::format("{} can not be written. It tells who drives the arm; remove it.", path.string()));
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    std::array<char, 128> name{};
    const ssize_t length = pread(file_, name.data(), name.size(), 0);
    close(file_);
    throw InUse(
        fmt::format("{} drives this arm already. End it first.",
                    length > 0 ? std::string(name.data(), static_cast<std::size_t>(length)) : "Another program"));
  }
  const std::string name = own_name();
  if (ftruncate(file_, 0) != 0 || pwrite(file_, name.data(), name.size(), 0) < 0) {
    close(file_);
    throw Error(fmt::format("{} can not be written: the disk is full.", path.string()));
  }
}

DriverClaim::~DriverClaim() { close(file_); }

}  // namespace inkwell::device
