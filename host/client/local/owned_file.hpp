// A file with one owner program at a time.
#pragma once

#include <sys/file.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/client/local/descriptor.hpp"

namespace inkwell::local {

/// Another program owns the file. `what()` is a sentence that names the program if the system provides its name.
class FileInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The lock is on the file itself (flock) and applies to every name and link of the file. The lock ends when the
/// process exits. Child processes do not inherit the lock.
class OwnedFile {
 public:
  using Flock = int (*)(int descriptor, int operation);

  /// A missing file is owned too, so that no other OwnedFile can create the file. Tests pass a substitute for flock.
  /// @throws FileInUse, or std::system_error if the file cannot be opened.
  explicit OwnedFile(const std::filesystem::path& path, Flock flock_like = &::flock);
  ~OwnedFile();

  /// Empty, or a sentence if the file system does not support locks. Without a lock, other programs can use the file.
  std::string warning() const;
  bool exists() const { return file_.is_open(); }
  /// Returns the content if the file has exactly this size. Returns an empty text if the file is not a regular file or
  /// has another size.
  std::vector<std::byte> content(std::size_t size) const;
  /// Replaces the content atomically, so that a reader finds the complete old or the complete new content.
  /// @throws FileInUse if another program has replaced the file. An exception leaves the file unchanged.
  void replace(std::span<const std::byte> content);

 private:
  void acquire();
  /// @throws FileInUse.
  void lock(const Descriptor& file);
  Descriptor open_next();
  void drop_next();

  std::filesystem::path path_, next_path_;
  Flock flock_;
  bool is_locked_ = true;
  Descriptor file_;   ///< the file with the name `path_`
  Descriptor first_;  ///< the original file, to which other hard links may refer
  Descriptor next_;   ///< written completely before it replaces the file; locked before others can see it
};

}  // namespace inkwell::local
