// What the file chooser shows of a folder, and what a typed name means. What the file system refuses becomes a
// sentence.
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
  std::uintmax_t bytes;  ///< of a file
  std::time_t changed;
};

struct FolderListing {
  std::vector<FolderEntry> entries;  ///< folders first, each kind by name; hidden ones left out
  std::string problem;               ///< why it could not be read; empty if it could
};

/// Files with one of these endings (".toml"); with none given, all of them.
FolderListing list_folder(const std::filesystem::path& folder, std::span<const std::string> endings);

/// Text that a user typed: relative to the folder unless it is absolute or begins with "~/".
std::filesystem::path typed_path(const std::filesystem::path& folder, std::string_view typed);

/// With the first of the endings if it has none of them.
std::filesystem::path with_ending(std::filesystem::path path, std::span<const std::string> endings);

/// Why this file cannot be read, or written, as far as one can tell without doing it; empty if it can be.
std::string reading_problem(const std::filesystem::path& file);
std::string writing_problem(const std::filesystem::path& file);

std::string size_text(std::uintmax_t bytes);  ///< "1.2 MB"
std::string date_text(std::time_t time);      ///< "2026-03-01 14:05"

}  // namespace inkwell::window
