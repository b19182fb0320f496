#include <doctest/doctest.h>

#include <map>

#include "host/companion/window/frame/key_letters.hpp"

using inkwell::window::key_letters;
using inkwell::window::KeyLetters;

namespace {

KeyLetters with(const std::map<int, const char*>& names) {
  return key_letters([&](int key) {
    const auto found = names.find(key);
    return found == names.end() ? nullptr : found->second;
  });
}

}  // namespace

TEST_CASE("a letter is on the key that writes it") {
  const KeyLetters german = with({{'Y', "z"}, {'Z', "y"}, {';', "ö"}});
  CHECK(german['z' - 'a'] == 'Y');
  CHECK(german['y' - 'a'] == 'Z');
  CHECK(german['a' - 'a'] == 'A');
  CHECK(with({{';', "m"}})['m' - 'a'] == ';');  // French: m is not on a letter key of the US layout
}

TEST_CASE("a letter that no key writes stays where an American keyboard has it") {
  CHECK(with({{'Z', "я"}})['z' - 'a'] == 'Z');
}
