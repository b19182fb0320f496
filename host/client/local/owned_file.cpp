#include "host/client/local/owned_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "host/client/local/interruption.hpp"
#include "host/client/local/process_name.hpp"
#include "host/client/local/replaced_file.hpp"

namespace inkwell::local {
namespace {

namespace fs = std::filesystem;

std::system_error failure(const fs::path& path) { return {errno, std::generic_category(), path.string()}; }

struct stat status_of(const Descriptor& file) {
  struct stat status {};
  ::fstat(file.number(), &status);
  return status;
}

bool is_named(const Descriptor& file, const fs::path& path) {
  struct stat named {};
  if (::stat(path.c_str(), &named) != 0) return false;
  const struct stat status = status_of(file);
  return named.st_dev == status.st_dev && named.st_ino == status.st_ino;
}

/// Returns the process that has locked this file, according to /proc/locks.
std::optional<pid_t> owner_of(const Descriptor& file) {
  const struct stat status = status_of(file);
  std::optional<pid_t> on_another_device;  // some file systems report different device numbers for their files
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    int process = 0;
    unsigned major_number = 0, minor_number = 0;
    unsigned long long inode = 0;
    if (std::sscanf(line.c_str(), "%*d: FLOCK %*s %*s %d %x:%x:%llu", &process, &major_number, &minor_number, &inode) !=
        4)
      continue;
    if (inode != status.st_ino || process <= 0) continue;
    if (major_number == major(status.st_dev) && minor_number == minor(status.st_dev)) return process;
    on_another_device = process;
  }
  return on_another_device;
}

/// Opens even a file without write permission, because a file is replaceable if its folder is writable.
Descriptor open_existing(const fs::path& path) {
  constexpr int flags = O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
  const auto open = [&](int access) {
    return Descriptor(repeat_interrupted([&] { return ::open(path.c_str(), access | flags); }));
  };
  Descriptor file = open(O_RDWR);
  if (!file.is_open() && errno != ENOENT) file = open(O_RDONLY);
  if (!file.is_open() && errno != ENOENT) throw failure(path);
  return file;
}

void write_all(const Descriptor& file, std::span<const std::byte> content, const fs::path& path) {
  if (repeat_interrupted([&] { return ::ftruncate(file.number(), 0); }) != 0) throw failure(path);
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t count = repeat_interrupted([&] {
      return ::pwrite(file.number(), content.data() + done, content.size() - done, static_cast<off_t>(done));
    });
    if (count <= 0) throw failure(path);
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace

OwnedFile::OwnedFile(const fs::path& path, Flock flock_like)
    : path_(resolve_symbolic_links(path)), next_path_(path_), flock_(flock_like) {
  next_path_ += ".new";
  acquire();
}

OwnedFile::~OwnedFile() { drop_next(); }

void OwnedFile::acquire() {
  for (;;) {
    Descriptor file = open_existing(path_);
    if (!file.is_open()) {
      next_ = open_next();
      std::error_code code;
      if (!fs::exists(path_, code)) return;
      drop_next();  // another program has just created the file
      continue;
    }
    lock(file);
    if (!is_named(file, path_)) continue;  // another program has just replaced the file
    file_ = std::move(file);
    return;
  }
}

void OwnedFile::lock(const Descriptor& file) {
  if (repeat_interrupted([&] { return flock_(file.number(), LOCK_EX | LOCK_NB); }) == 0) return;
  if (errno != EWOULDBLOCK) {
    is_locked_ = false;
    return;
  }
  const auto owner = owner_of(file);
  throw FileInUse(fmt::format("{} is in use by {}. Close that program first, or give another file.", path_.string(),
                              owner ? name_of_process(*owner) : "another program"));
}

/// Opens and locks the new file. Every program locks the new file before it replaces or creates the owned file, so only
/// one program does this at a time.
Descriptor OwnedFile::open_next() {
  for (;;) {
    Descriptor next(::open(next_path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK, 0666));
    if (!next.is_open()) throw failure(next_path_);
    if (!S_ISREG(status_of(next).st_mode)) {
      errno = EEXIST;
      throw failure(next_path_);
    }
    lock(next);
    if (is_named(next, next_path_)) return next;
  }
}

void OwnedFile::drop_next() {
  if (!next_.is_open()) return;
  std::error_code ignored;
  fs::remove(next_path_, ignored);
  next_ = Descriptor();
}

std::string OwnedFile::warning() const {
  if (is_locked_) return {};
  return fmt::format("The file system of {} has no locks. Let no other program use the file at the same time.",
                     path_.string());
}

std::vector<std::byte> OwnedFile::content(std::size_t size) const {
  const struct stat status = status_of(file_);
  if (!exists() || !S_ISREG(status.st_mode) || static_cast<std::uintmax_t>(status.st_size) != size) return {};
  std::vector<std::byte> content(size);
  for (std::size_t done = 0; done < size;) {
    const ssize_t count = repeat_interrupted(
        [&] { return ::pread(file_.number(), content.data() + done, size - done, static_cast<off_t>(done)); });
    if (count <= 0) return {};
    done += static_cast<std::size_t>(count);
  }
  return content;
}

void OwnedFile::replace(std::span<const std::byte> content) {
  if (!next_.is_open()) next_ = open_next();
  try {
    std::error_code code;
    if (fs::exists(path_, code) && !(exists() && is_named(file_, path_)))
      throw FileInUse(
          fmt::format("{} was replaced by another file while this program used it. The new file was not changed. Start "
                      "the program again.",
                      path_.string()));
    if (exists()) ::fchmod(next_.number(), status_of(file_).st_mode & 07777);
    write_all(next_, content, next_path_);
    if (::rename(next_path_.c_str(), path_.c_str()) != 0) throw failure(path_);
  } catch (...) {
    drop_next();
    throw;
  }
  if (!first_.is_open()) first_ = std::move(file_);
  file_ = std::exchange(next_, Descriptor());
}

}  // namespace inkwell::local
