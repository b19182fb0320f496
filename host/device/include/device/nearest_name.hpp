// Finds what was probably meant by a name that is misspelt.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

#include <device/error.hpp>

namespace inkwell::device {

/// A name that no table has. It may be one of a device's own force law, if none was opened yet.
class UnknownName : public Error {
 public:
  using Error::Error;
};

/// Levenshtein's distance: how many characters must be inserted, removed or exchanged.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name in a table of rows with a `name` that takes the fewest edits. The table must not be empty.
template <class Table>
std::string_view nearest_name(const Table& table, std::string_view name) {
  return std::min_element(
             std::begin(table), std::end(table),
             [&](const auto& a, const auto& b) { return edit_distance(name, a.name) < edit_distance(name, b.name); })
      ->name;
}

}  // namespace inkwell::device
