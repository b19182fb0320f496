#include "host/companion/window/frame/font_search.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <ft2build.h>
#include FT_FREETYPE_H

namespace inkwell::window {

namespace fs = std::filesystem;

namespace {

std::string in_small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return text;
}

/// Returns a smaller number for a better font.
int rank_of(const fs::path& file) {
  const std::string name = in_small_letters(file.stem().string());
  const auto has = [&name](std::string_view part) { return name.find(part) != std::string::npos; };
  int rank = 0;
  for (const std::string_view style : {"bold", "italic", "oblique", "black", "light", "thin", "condensed", "mono"})
    if (has(style)) rank += 10;
  if (!has("sans") && !has("gothic")) rank += 2;
  if (has("serif") && !has("sans")) rank += 3;
  return rank;
}

/// Moves the characters that the face contains to `choice`.
void take_from_face(FT_Face face, std::vector<Character>& missing, FontChoice& choice) {
  if (FT_IS_SCALABLE(face) == 0 || FT_Select_Charmap(face, FT_ENCODING_UNICODE) != 0) return;
  std::erase_if(missing, [&](Character character) {
    if (FT_Get_Char_Index(face, character) == 0) return false;
    choice.characters.push_back(character);
    return true;
  });
}

}  // namespace

std::vector<fs::path> font_folders() {
  std::vector<fs::path> folders{"/usr/share/fonts", "/usr/local/share/fonts"};
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
    folders.push_back(fs::path(home) / ".local/share/fonts");
    folders.push_back(fs::path(home) / ".fonts");
  }
  return folders;
}

std::vector<fs::path> installed_fonts(const std::vector<fs::path>& folders) {
  std::vector<fs::path> fonts;
  for (const fs::path& folder : folders) {
    std::error_code error;
    constexpr auto options =
        fs::directory_options::follow_directory_symlink | fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator each(folder, options, error), end; !error && each != end;
         each.increment(error)) {
      constexpr int deepest = 8;  // a link to a parent folder must not cause an endless search
      if (each.depth() >= deepest) each.disable_recursion_pending();
      static constexpr std::array<std::string_view, 3> endings{".ttf", ".otf", ".ttc"};
      if (std::ranges::find(endings, in_small_letters(each->path().extension().string())) != endings.end())
        fonts.push_back(each->path());
    }
  }
  std::ranges::sort(fonts, {}, [](const fs::path& file) { return std::pair(rank_of(file), file); });
  return fonts;
}

std::vector<FontChoice> fonts_for(std::vector<Character> characters, const std::vector<fs::path>& fonts) {
  std::vector<FontChoice> choices;
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) return choices;
  for (const fs::path& file : fonts) {
    if (characters.empty()) break;
    for (FT_Long index = 0, count = 1; index < count; ++index) {
      FT_Face face = nullptr;
      if (FT_New_Face(library, file.c_str(), index, &face) != 0) break;
      count = face->num_faces;
      FontChoice choice{file, static_cast<int>(index), {}};
      take_from_face(face, characters, choice);
      FT_Done_Face(face);
      if (!choice.characters.empty()) choices.push_back(std::move(choice));
    }
  }
  FT_Done_FreeType(library);
  return choices;
}

}  // namespace inkwell::window
