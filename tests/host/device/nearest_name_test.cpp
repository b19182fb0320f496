#include <doctest/doctest.h>

#include <device/nearest_name.hpp>

using inkwell::device::edit_distance;

TEST_CASE("a character that is inserted, removed or exchanged is one edit") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("force", "force") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("abc", "") == 3);
  CHECK(edit_distance("abc", "abxc") == 1);
  CHECK(edit_distance("abxc", "abc") == 1);
  CHECK(edit_distance("abc", "axc") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
}
