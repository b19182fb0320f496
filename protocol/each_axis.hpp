// Groups of three table rows, for axes 1 to 3 or x to z.
//
// The names of the three rows differ only in the digit or letter, for example gear_ratio_1, gear_ratio_2, gear_ratio_3.
// Callers pass the first row and an index. of_axis() counts from 0 as in arrays. of_number() counts from 1 as in the
// row names.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace inkwell::protocol {

namespace detail {

/// Returns the position of the axis in a name: a separate digit 1 to 3 or letter x to z. Returns npos if the name has
/// no axis.
constexpr std::size_t axis_position(std::string_view name) {
  for (std::size_t i = 1; i < name.size(); ++i) {
    const bool alone = name[i - 1] == '_' && (i + 1 == name.size() || name[i + 1] == '_');
    if (alone && ((name[i] >= '1' && name[i] <= '3') || (name[i] >= 'x' && name[i] <= 'z'))) return i;
  }
  return std::string_view::npos;
}

/// Returns true if the axis of `name` is `distance` after the axis of `other` and the names are otherwise equal.
constexpr bool is_named_after(std::string_view name, std::string_view other, int distance) {
  const std::size_t position = axis_position(other);
  return position != std::string_view::npos && name.size() == other.size() && axis_position(name) == position &&
         name[position] == other[position] + distance && name.substr(0, position) == other.substr(0, position) &&
         name.substr(position + 1) == other.substr(position + 1);
}

// A call of these functions causes a compiler error that contains the function name.
void the_table_has_no_three_rows_of_this_name();
void the_three_rows_differ_in_unit_range_or_kind();

}  // namespace detail

/// Three rows of a table (Parameter or Signal). The compiler derives the rows from the first row and compares names,
/// units, kinds and ranges.
template <class Row>
class EachAxis {
 public:
  // The constructor is implicit, so that a row converts to an EachAxis.
  consteval EachAxis(Row first) : EachAxis(first, named_after(first, 1), named_after(first, 2)) {}
  /// Groups three rows with unrelated names.
  consteval EachAxis(Row first, Row second, Row third) : rows_{first, second, third} {
    for (const Row row : rows_)
      if (!alike(info(row), info(first))) detail::the_three_rows_differ_in_unit_range_or_kind();
  }

  constexpr Row operator[](std::size_t axis) const { return rows_[axis]; }

 private:
  static consteval Row named_after(Row first, int distance) {
    for (std::size_t i = 0; i < row_count(first); ++i)
      if (detail::is_named_after(info(static_cast<Row>(i)).name, info(first).name, distance))
        return static_cast<Row>(i);
    detail::the_table_has_no_three_rows_of_this_name();
    return first;
  }

  std::array<Row, 3> rows_;
};

}  // namespace inkwell::protocol
