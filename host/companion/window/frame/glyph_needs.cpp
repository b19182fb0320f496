#include "host/companion/window/frame/glyph_needs.hpp"

#include <bitset>
#include <cstddef>

namespace inkwell::window {

namespace {

constexpr std::size_t plane = 0x10000;

std::bitset<plane> recorded;
std::size_t recorded_count = 0;

}  // namespace

std::vector<Character> characters_of(std::string_view text) {
  std::vector<Character> characters;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || i + length > text.size()) {
      ++i;
      continue;
    }
    char32_t code = length == 2 ? lead & 0x1Fu : length == 3 ? lead & 0x0Fu : lead & 0x07u;
    bool is_valid = true;
    for (std::size_t k = 1; k < length; ++k) {
      const auto byte = static_cast<unsigned char>(text[i + k]);
      is_valid &= (byte & 0xC0u) == 0x80u;
      code = code << 6 | (byte & 0x3Fu);
    }
    if (!is_valid) {
      ++i;
      continue;
    }
    if (length > 1 && code < plane) characters.push_back(static_cast<Character>(code));
    i += length;
  }
  return characters;
}

void need_glyphs(std::string_view text) {
  for (const char byte : text) {
    if (static_cast<unsigned char>(byte) < 0x80) continue;
    for (const Character character : characters_of(text)) {
      if (recorded.test(character)) continue;
      recorded.set(character);
      ++recorded_count;
    }
    return;
  }
}

std::size_t needed_count() { return recorded_count; }

std::vector<Character> needed_characters() {
  std::vector<Character> characters;
  for (std::size_t i = 0; i < plane; ++i)
    if (recorded.test(i)) characters.push_back(static_cast<Character>(i));
  return characters;
}

}  // namespace inkwell::window
