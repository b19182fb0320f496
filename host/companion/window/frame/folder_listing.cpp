#include "host/companion/window/frame/folder_listing.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <system_error>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include "host/client/local/text_file.hpp"

namespace inkwell::window {

namespace fs = std::filesystem;

namespace {

std::string folder_problem(const fs::path& folder, const std::error_code& error) {
  if (error == std::errc::no_such_file_or_directory)
    return fmt::format("The folder {} does not exist. Choose another folder.", folder.string());
  if (error == std::errc::not_a_directory) return fmt::format("{} is a file, not a folder.", folder.string());
  if (error == std::errc::permission_denied)
    return fmt::format("You have no permission to read the folder {}. Choose another folder.", folder.string());
  return fmt::format("The folder {} cannot be read: {}.", folder.string(), error.message());
}

std::time_t to_time(fs::file_time_type time) {
  return std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(std::chrono::file_clock::to_sys(time)));
}

bool has_ending(const fs::path& path, std::span<const std::string> endings) {
  return endings.empty() ||
         std::ranges::any_of(endings, [&](const std::string& ending) { return local::has_extension(path, ending); });
}

}  // namespace

FolderListing list_folder(const fs::path& folder, std::span<const std::string> endings) {
  FolderListing listing;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  if (error) return {{}, folder_problem(folder, error)};
  for (; entry != fs::directory_iterator(); entry.increment(error)) {
    // Omits deleted entries and entries without access permission.
    std::error_code of_entry;
    const std::string name = entry->path().filename().string();
    const bool is_folder = entry->is_directory(of_entry);
    if (of_entry || name.starts_with('.')) continue;
    if (!is_folder && (!entry->is_regular_file(of_entry) || !has_ending(entry->path(), endings))) continue;
    const auto bytes = is_folder ? 0 : entry->file_size(of_entry);
    const auto changed = entry->last_write_time(of_entry);
    if (!of_entry) listing.entries.push_back({name, is_folder, bytes, to_time(changed)});
  }
  if (error) listing.problem = folder_problem(folder, error);
  std::ranges::sort(listing.entries, [](const FolderEntry& a, const FolderEntry& b) {
    return a.is_folder != b.is_folder ? a.is_folder : a.name < b.name;
  });
  return listing;
}

fs::path typed_path(const fs::path& folder, std::string_view typed) {
  const char* home = std::getenv("HOME");
  if (home != nullptr && (typed == "~" || typed.starts_with("~/")))
    return (fs::path(home) / typed.substr(std::min<std::size_t>(2, typed.size()))).lexically_normal();
  return (folder / typed).lexically_normal();
}

fs::path with_ending(fs::path path, std::span<const std::string> endings) {
  if (!endings.empty() && !has_ending(path, endings)) path += endings.front();
  return path;
}

std::string reading_problem(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return fmt::format("The file {} does not exist. Choose another file.", file.string());
  if (fs::is_directory(file, error)) return fmt::format("{} is a folder, not a file.", file.string());
  if (access(file.c_str(), R_OK) != 0)
    return fmt::format("You have no permission to read the file {}. Choose another file.", file.string());
  return {};
}

std::string writing_problem(const fs::path& file) {
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (fs::is_directory(file, error)) return fmt::format("{} is a folder. Type a file name.", file.string());
  if (!fs::is_directory(folder, error))
    return fmt::format("The folder {} does not exist. Choose another folder.", folder.string());
  if (access(folder.c_str(), W_OK) != 0 || (fs::exists(file, error) && access(file.c_str(), W_OK) != 0))
    return fmt::format("You have no permission to write the file {}. Choose another folder.", file.string());
  return {};
}

std::string size_text(std::uintmax_t bytes) {
  const auto count = static_cast<double>(bytes);
  if (bytes < 1'000) return fmt::format("{} B", bytes);
  if (bytes < 1'000'000) return fmt::format("{:.1f} kB", 1e-3 * count);
  if (bytes < 1'000'000'000) return fmt::format("{:.1f} MB", 1e-6 * count);
  return fmt::format("{:.1f} GB", 1e-9 * count);
}

std::string date_text(std::time_t time) { return fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(time)); }

}  // namespace inkwell::window
