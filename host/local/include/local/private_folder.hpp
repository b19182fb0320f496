// A folder that only this user can enter.
#pragma once

#include <filesystem>

namespace inkwell::local {

/// In the user's runtime folder (XDG_RUNTIME_DIR) if there is one, else in that for temporary files. Removed with the
/// object if it is empty then.
class PrivateFolder {
 public:
  /// @throws std::runtime_error with a sentence.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace inkwell::local
