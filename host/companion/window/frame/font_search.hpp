// Finds installed fonts for characters that the main font does not contain.
#pragma once

#include <filesystem>
#include <vector>

#include "host/companion/window/frame/glyph_needs.hpp"

namespace inkwell::window {

struct FontChoice {
  std::filesystem::path file;
  int face = 0;  ///< index of the face in a font collection
  std::vector<Character> characters;
};

/// Returns the folders with installed fonts: of the system, of the computer and of the user.
std::vector<std::filesystem::path> font_folders();

/// Returns the installed font files. Upright fonts without serifs are first.
std::vector<std::filesystem::path> installed_fonts(const std::vector<std::filesystem::path>& folders);

/// Assigns each character to the first font that contains the character. Characters without a font are omitted.
/// Takes up to a second, so the window calls this function in a separate thread.
std::vector<FontChoice> fonts_for(std::vector<Character> characters, const std::vector<std::filesystem::path>& fonts);

}  // namespace inkwell::window
