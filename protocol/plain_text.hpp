// Makes text from a file or a device safe to print. Control characters could move the terminal's cursor, change
// terminal settings, or join lines of a script.
#pragma once

// Call plain_text() where a text from a file, a device or another program is read. device::Error already filters its
// text.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace inkwell::protocol {

/// Returns the size in bytes of the printable character at the beginning of a text. Returns 0 for an empty text, a
/// control character, a change of the writing direction, or invalid UTF-8.
constexpr std::size_t printable_length(std::string_view text) {
  if (text.empty()) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t length = first < 0xC0 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF8 ? 4 : 0;
  if (length == 0 || length > text.size()) return 0;
  std::uint32_t code = first & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  constexpr std::uint32_t shortest[] = {0, 0, 0x80, 0x800, 0x1'0000};
  const auto is_between = [code](std::uint32_t lowest, std::uint32_t highest) {
    return code >= lowest && code <= highest;
  };
  const bool is_utf8 = code >= shortest[length] && code <= 0x10'FFFF && !is_between(0xD800, 0xDFFF);
  const bool is_control = is_between(0x80, 0x9F) || is_between(0x2028, 0x202E) || is_between(0x2066, 0x2069);
  return is_utf8 && !is_control ? length : 0;
}

/// Replaces tabs and line ends by spaces, and other unprintable bytes by '?'. The length in bytes does not change.
inline std::string plain_text(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t length = printable_length(text);
    if (length > 0)
      plain += text.substr(0, length);
    else
      plain += text[0] == '\t' || text[0] == '\n' || text[0] == '\r' ? ' ' : '?';
    text.remove_prefix(length > 0 ? length : 1);
  }
  return plain;
}

/// Filters multi-line text like plain_text(), but retains tabs and line feeds.
inline std::string plain_lines(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\t\n");
    plain += plain_text(text.substr(0, end));
    if (end == text.npos) break;
    plain += text[end];
    text.remove_prefix(end + 1);
  }
  return plain;
}

}  // namespace inkwell::protocol
