// Tests which characters a text needs, and which installed font contains the characters.
#include <doctest/doctest.h>

#include <algorithm>

#include "host/companion/window/frame/font_search.hpp"

using namespace inkwell::window;

TEST_CASE("a text needs its characters outside ASCII, and invalid bytes are skipped") {
  CHECK(characters_of("push.h5").empty());
  CHECK(characters_of("\u0416\u00e9 \u4e2d") == std::vector<Character>{0x0416, 0x00e9, 0x4e2d});
  CHECK(characters_of("a\xff\xc3(\xe4\xb8") == std::vector<Character>{});
  CHECK(characters_of("\U0001F600x\u05d0") == std::vector<Character>{0x05d0});  // ImGui draws only the first plane
}

TEST_CASE("displayed texts are recorded once") {
  need_glyphs("\u0e2a\u0e2a");
  need_glyphs("plain");
  const auto needed = needed_characters();
  CHECK(std::ranges::count(needed, Character{0x0e2a}) == 1);
  CHECK(std::ranges::is_sorted(needed));
}

TEST_CASE("each character has at most one font, and upright fonts are preferred") {
  const auto fonts = installed_fonts(font_folders());
  REQUIRE_FALSE(fonts.empty());
  constexpr Character private_use = 0xE9A7;  // no font of Debian contains this character
  const std::vector<Character> wanted{u'A', 0x0416, 0x05d0, 0x0e2a, private_use};
  const auto choices = fonts_for(wanted, fonts);
  std::vector<Character> found;
  for (const FontChoice& choice : choices) {
    CHECK(std::filesystem::exists(choice.file));
    found.insert(found.end(), choice.characters.begin(), choice.characters.end());
  }
  std::ranges::sort(found);
  CHECK(std::ranges::adjacent_find(found) == found.end());
  CHECK(std::ranges::find(found, u'A') != found.end());
  CHECK(std::ranges::find(found, private_use) == found.end());
  const auto name = [](const std::filesystem::path& file) { return file.filename().string(); };
  const auto bold =
      std::ranges::find_if(fonts, [&](const auto& file) { return name(file).find("Bold") != std::string::npos; });
  const auto regular =
      std::ranges::find_if(fonts, [&](const auto& file) { return name(file).find("Regular") != std::string::npos; });
  CHECK((bold == fonts.end() || regular == fonts.end() || regular < bold));
}

TEST_CASE("a folder that does not exist has no fonts, and a damaged font is skipped") {
  CHECK(installed_fonts({"/nonexistent"}).empty());
  CHECK(fonts_for({u'A'}, {"/etc/passwd", "/nonexistent.ttf"}).empty());
}
