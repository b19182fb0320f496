#include "host/client/device/nearest_name.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace inkwell::device {

// Computes only the table cells that can be at most `most`.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most) {
  const std::size_t beyond = most + 1;
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > most) return beyond;
  std::vector<std::size_t> row(b.size() + 1, beyond);
  for (std::size_t j = 0; j <= std::min(b.size(), most); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    const std::size_t first = i > most ? i - most : 1, last = std::min(b.size(), i + most);
    std::size_t diagonal = std::exchange(row[first - 1], first == 1 ? std::min(i, beyond) : beyond);
    std::size_t least = row[first - 1];
    for (std::size_t j = first; j <= last; ++j) {
      const std::size_t exchanged = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min(std::min(row[j], row[j - 1]) + 1, exchanged);
      least = std::min(least, row[j]);
    }
    if (least >= beyond) return beyond;
  }
  return std::min(row.back(), beyond);
}

bool is_near(std::string_view name, std::string_view typed) {
  constexpr std::size_t telling = 3;  // many names share one or two letters
  if (typed.size() < telling) return false;
  const auto is_within = [&](std::string_view other, std::size_t edits) {
    return edit_distance(typed, other, edits) <= edits;
  };
  return name.find(typed) != std::string_view::npos || is_within(name, typed.size() / 3) ||
         is_within(name.substr(0, typed.size()), typed.size() / 4);
}

}  // namespace inkwell::device
