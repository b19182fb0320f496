// Lists folders and converts typed names for the file chooser. The functions return file system errors as sentences.
#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace inkwell::window {

struct FolderEntry {
  std::string name;
  bool is_folder;
  std::uintmax_t bytes;  ///< size of a file
  std::time_t changed;
};

struct FolderListing {
  std::vector<FolderEntry> entries;  ///< folders first, each kind sorted by name, without hidden entries
  std::string problem;               ///< reason why the folder could not be read; empty on success
};

/// Lists the contents of a folder. If `endings` is not empty, omits files with other extensions.
FolderListing list_folder(const std::filesystem::path& folder, std::span<const std::string> endings);

/// Converts typed text to a path. The path is relative to the folder unless the text starts with "/" or "~/".
std::filesystem::path typed_path(const std::filesystem::path& folder, std::string_view typed);

/// Appends the first extension of `endings` if the path has no extension from `endings`.
std::filesystem::path with_ending(std::filesystem::path path, std::span<const std::string> endings);

/// Returns the reason why the file cannot be read or written, or an empty text.
std::string reading_problem(const std::filesystem::path& file);
std::string writing_problem(const std::filesystem::path& file);

std::string size_text(std::uintmax_t bytes);  ///< "1.2 MB"
std::string date_text(std::time_t time);      ///< "2026-03-01 14:05"

}  // namespace inkwell::window
