// Suggests similar names for misspelled names.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "host/client/device/error.hpp"

namespace inkwell::device {

/// No table contains this name. An unopened device may have a force law with this name.
class UnknownName : public Error {
 public:
  using Error::Error;
};

/// Returns the Levenshtein distance. Returns `most` + 1 if the distance is larger than `most`.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most);

/// Returns true if the user probably meant `name`. The name must contain the typed text, or its beginning must be
/// similar to the typed text.
bool is_near(std::string_view name, std::string_view typed);

/// Returns " Did you mean NAME?" with the most similar name, or an empty text. A name that contains the typed text has
/// priority over all other names.
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
