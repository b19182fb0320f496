// Copies texts to C character arrays.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>

namespace inkwell::library {

/// Size of the buffer for an error text, with the terminating zero.
inline constexpr std::size_t sentence_maximum = 2048;

/// Copies a zero-terminated text and truncates the text to the array size.
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
