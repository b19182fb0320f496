// Texts in the structs of the C interface.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>

namespace inkwell::library {

/// As much of the text as there is room for, and its end.
template <std::size_t size>
void copy_text(const std::string& text, char (&to)[size]) {
  std::strncpy(to, text.c_str(), size - 1);
  to[size - 1] = '\0';
}

}  // namespace inkwell::library
