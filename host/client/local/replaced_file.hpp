// Replaces files completely or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace inkwell::local {

/// Returns the target of a symbolic link, or the path itself.
std::filesystem::path resolve_symbolic_links(std::filesystem::path path);

/// A new file that is written next to an older file, and then replaces the older file. A symbolic link remains a link,
/// and the file that the link names is replaced. The new file has the mode and, if permitted, the owner of the older
/// file. Until then the older file is unchanged, so that a full disk destroys nothing.
class ReplacedFile {
 public:
  explicit ReplacedFile(const std::filesystem::path& file);
  /// Removes the new file if it has not replaced the older file.
  ~ReplacedFile();
  ReplacedFile(const ReplacedFile&) = delete;
  ReplacedFile& operator=(const ReplacedFile&) = delete;

  /// The name of the new file, with the extension of the file. No file has this name at first.
  const std::filesystem::path& path() const { return path_; }
  /// @throws std::system_error if the new file cannot replace the older file.
  void replace();

 private:
  std::filesystem::path file_, path_;
};

/// Replaces the content of a file, or creates the file. A device or a pipe is written directly.
/// @throws std::system_error.
void replace_file(const std::filesystem::path& file, std::string_view content);

}  // namespace inkwell::local
