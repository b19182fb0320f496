// A folder that only this user can access.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>

namespace inkwell::local {

/// The folder has mode 0700 and is removed with its files when the object is destroyed. for_files() and for_sockets()
/// throw std::runtime_error with a sentence.
class PrivateFolder {
 public:
  /// Creates the private folder in the folder for temporary files.
  static PrivateFolder for_files();
  /// Creates the private folder in the user's runtime folder (XDG_RUNTIME_DIR) if that folder exists, otherwise in the
  /// folder for temporary files. The path is short enough for sockets, and no other user can replace the folder.
  static PrivateFolder for_sockets();
  ~PrivateFolder();
  PrivateFolder(PrivateFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  PrivateFolder& operator=(PrivateFolder&&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  /// Creates the folder in the first suitable parent.
  explicit PrivateFolder(std::span<const std::string> parents);

  std::filesystem::path path_;
};

}  // namespace inkwell::local
