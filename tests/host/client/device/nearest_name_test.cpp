#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/nearest_name.hpp"

using inkwell::device::edit_distance;

namespace {

constexpr std::size_t all = 100;

std::size_t plain_distance(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const std::string_view shorter_a = a.substr(1), shorter_b = b.substr(1);
  return std::min({plain_distance(shorter_a, b) + 1, plain_distance(a, shorter_b) + 1,
                   plain_distance(shorter_a, shorter_b) + (a[0] != b[0])});
}

}  // namespace

TEST_CASE("a character that is inserted, removed or exchanged is one edit") {
  CHECK(edit_distance("", "", all) == 0);
  CHECK(edit_distance("force", "force", all) == 0);
  CHECK(edit_distance("", "abc", all) == 3);
  CHECK(edit_distance("abc", "", all) == 3);
  CHECK(edit_distance("abc", "abxc", all) == 1);
  CHECK(edit_distance("abxc", "abc", all) == 1);
  CHECK(edit_distance("abc", "axc", all) == 1);
  CHECK(edit_distance("kitten", "sitting", all) == 3);
}

TEST_CASE("edit_distance returns at most one more than the requested maximum") {
  std::vector<std::string> words{""};
  for (std::size_t i = 0; words[i].size() < 4; ++i)
    for (const char letter : {'a', 'b'}) words.push_back(words[i] + letter);
  for (const std::string& a : words)
    for (const std::string& b : words)
      for (std::size_t most = 0; most < 6; ++most) {
        const bool is_right = edit_distance(a, b, most) == std::min(plain_distance(a, b), most + 1);
        if (!is_right) FAIL_CHECK(a, " and ", b, ", at most ", most);
      }
}
