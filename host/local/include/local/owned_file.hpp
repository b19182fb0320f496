// A file that one program has at a time.
#pragma once

#include <sys/file.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <local/descriptor.hpp>

namespace inkwell::local {

/// Another program has the file. `what()` is a sentence that names the program if the system reveals it.
class FileInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The lock is on the file itself (flock): it holds for every name and link of the file, and ends with the process,
/// however that ends. Programs that are started meanwhile do not inherit it.
class OwnedFile {
 public:
  using Flock = int (*)(int descriptor, int operation);

  /// A file that does not exist is owned too: no other program can create it in this way.
  /// Tests pass another function than flock.
  /// @throws FileInUse, or std::system_error if the file cannot be opened.
  explicit OwnedFile(const std::filesystem::path& path, Flock flock_like = &::flock);
  ~OwnedFile();

  /// Empty, or a sentence where the file system has no locks: then nothing keeps other programs from the file.
  std::string warning() const;
  bool exists() const { return file_.is_open(); }
  /// The whole content if it has this size; empty if it has another, or if this is not a regular file.
  std::vector<std::byte> content(std::size_t size) const;
  /// Replaces the content. Whoever reads the file meanwhile finds all of the old or all of the new content.
  /// @throws FileInUse if the file was exchanged for another one, which stays as it is; std::system_error if it cannot
  /// be written.
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
  Descriptor file_;   ///< what `path_` names now
  Descriptor first_;  ///< the original file: other hard links may still refer to it
  Descriptor next_;   ///< written in full before it takes the place of the file; locked before others can see it
};

}  // namespace inkwell::local
