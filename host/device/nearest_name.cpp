#include <device/nearest_name.hpp>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace inkwell::device {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

bool is_near(std::string_view name, std::string_view typed) {
  constexpr std::size_t telling = 3;  // a letter or two are in many names
  if (typed.size() < telling) return false;
  return name.find(typed) != std::string_view::npos || edit_distance(typed, name) <= typed.size() / 3 ||
         edit_distance(typed, name.substr(0, typed.size())) <= typed.size() / 4;
}

}  // namespace inkwell::device
