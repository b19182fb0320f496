// Text files as the editors and spreadsheets of all systems write them.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

namespace inkwell::local {

inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// Removes the mark that Windows programs write at the start of a UTF-8 file.
constexpr std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  return text;
}

/// Removes the carriage return that is left when a line of a Windows file is split at its line feed.
constexpr std::string_view without_carriage_return(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// `extension`: in lower case, with its dot. Some systems write extensions in upper case.
inline bool has_extension(const std::filesystem::path& file, std::string_view extension) {
  std::string own = file.extension().string();
  std::ranges::transform(own, own.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return own == extension;
}

}  // namespace inkwell::local
