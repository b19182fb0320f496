// Copies texts to C character arrays.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>

namespace inkwell::library {

/// Longest error sentence, including the terminating zero.
inline constexpr std::size_t sentence_maximum = 2048;

/// Copies the text with a terminating zero, truncated to the size of the array.
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
