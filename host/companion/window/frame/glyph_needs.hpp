// Characters of displayed texts that the loaded fonts do not contain yet.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace inkwell::window {

/// Characters of the Basic Multilingual Plane; ImGui draws no other characters.
using Character = char16_t;

/// Returns the characters of a UTF-8 text without ASCII. Skips invalid bytes and characters outside the plane.
std::vector<Character> characters_of(std::string_view text);

/// Records the characters of a displayed text. The next font atlas contains these characters. Only the window's thread
/// may call this function.
void need_glyphs(std::string_view text);

/// Number of recorded characters.
std::size_t needed_count();

/// Returns all recorded characters, sorted.
std::vector<Character> needed_characters();

}  // namespace inkwell::window
