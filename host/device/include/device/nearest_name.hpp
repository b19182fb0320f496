// Finds what was probably meant by a name that is misspelt.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include <device/error.hpp>

namespace inkwell::device {

/// A name that no table has. It may be one of a device's own force law, if none was opened yet.
class UnknownName : public Error {
 public:
  using Error::Error;
};

/// Levenshtein's distance: how many characters must be inserted, removed or exchanged.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name in a table of rows with a `name` that was probably meant: one that has the typed text in it, else one that
/// takes few edits. The table must not be empty.
template <class Table>
std::string_view nearest_name(const Table& table, std::string_view name) {
  const auto distance = [name](const auto& row) {
    const bool holds_it = !name.empty() && std::string_view(row.name).find(name) != std::string_view::npos;
    return std::pair(!holds_it, edit_distance(name, row.name));
  };
  return std::min_element(std::begin(table), std::end(table),
                          [&](const auto& a, const auto& b) { return distance(a) < distance(b); })
      ->name;
}

}  // namespace inkwell::device
