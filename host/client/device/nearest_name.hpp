// Finds the intended name for a misspelled name.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "host/client/device/error.hpp"

namespace inkwell::device {

/// A name is missing in all tables. The name may belong to the force law of a device that was not opened yet.
class UnknownName : public Error {
 public:
  using Error::Error;
};

/// Levenshtein distance: the number of insertions, removals and replacements. A distance above `most` is returned as
/// `most` + 1.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most);

/// Whether the user probably meant `name`. Returns true if `name` contains the typed text, or if few edits change the
/// typed text to `name` or to its beginning.
bool is_near(std::string_view name, std::string_view typed);

/// " Did you mean NAME?" with the most similar name of the table. A name that contains the typed text has priority over
/// a name that differs by few edits. Empty if no name is similar.
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
