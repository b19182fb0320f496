// Texts in the memory of the C interface.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>

namespace inkwell::library {

/// The longest sentence that a thread is told.
inline constexpr std::size_t sentence_maximum = 2048;

/// As much of the text as there is room for, and its end.
template <std::size_t size>
void copy_text(const char* text, char (&to)[size]) {
  std::strncpy(to, text, size - 1);
  to[size - 1] = '\0';
}
template <std::size_t size>
void copy_text(const std::string& text, char (&to)[size]) {
  copy_text(text.c_str(), to);
}

}  // namespace inkwell::library
