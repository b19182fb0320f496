// Finds what was probably meant by a name that is misspelt.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <device/error.hpp>

namespace inkwell::device {

/// A name that no table has. It may be one of a device's own force law, if none was opened yet.
class UnknownName : public Error {
 public:
  using Error::Error;
};

/// Levenshtein's distance: how many characters must be inserted, removed or exchanged. More than `most` are told as one
/// more than that.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most);

/// Whether `name` was probably meant by the typed text: it has the text in it, or takes few edits, be it as a whole or
/// as far as the text goes.
bool is_near(std::string_view name, std::string_view typed);

/// " Did you mean NAME?" with the name in a table of rows with a `name` that was probably meant: one that has the typed
/// text in it, else one that takes few edits. Empty if none is near.
template <class Table>
std::string suggestion(const Table& table, std::string_view typed) {
  const std::string_view* nearest = nullptr;
  std::pair<bool, std::size_t> shortest;
  for (const auto& row : table) {
    const std::string_view& name = row.name;
    if (!is_near(name, typed)) continue;
    const std::pair distance(name.find(typed) == std::string_view::npos,
                             edit_distance(typed, name, std::max(typed.size(), name.size())));
    if (nearest != nullptr && shortest <= distance) continue;
    nearest = &name;
    shortest = distance;
  }
  return nearest == nullptr ? "" : " Did you mean " + std::string(*nearest) + "?";
}

}  // namespace inkwell::device
