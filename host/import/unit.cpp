#include "host/import/unit.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace inkwell::importer {
namespace {

struct UnitRow {
  Unit unit;
  std::string_view symbol;
  double length_m;
};

constexpr std::array unit_rows{UnitRow{Unit::millimeter, "mm", 1e-3}, UnitRow{Unit::centimeter, "cm", 1e-2},
                               UnitRow{Unit::meter, "m", 1.0}, UnitRow{Unit::inch, "in", 25.4e-3}};

const UnitRow& row_of(Unit unit) { return *std::ranges::find(unit_rows, unit, &UnitRow::unit); }

}  // namespace

std::string_view symbol_of(Unit unit) { return row_of(unit).symbol; }

double meters_per(Unit unit) { return row_of(unit).length_m; }

std::optional<Unit> parse_unit(std::string_view symbol) {
  const auto row = std::ranges::find(unit_rows, symbol, &UnitRow::symbol);
  return row == unit_rows.end() ? std::nullopt : std::optional(row->unit);
}

Unit propose_unit(double length) {
  struct Range {
    double minimum_m, maximum_m;
  };
  constexpr Range comfortable{0.01, 0.4}, possible{0.002, 2.0};
  for (const Range& range : {comfortable, possible})
    for (const Unit unit : {Unit::millimeter, Unit::meter, Unit::centimeter, Unit::inch})
      if (const double length_m = length * meters_per(unit); length_m >= range.minimum_m && length_m <= range.maximum_m)
        return unit;
  return length > 1 ? Unit::millimeter : Unit::meter;
}

std::string length_text(double length_m) {
  if (length_m >= 1 || length_m == 0) return fmt::format("{:.3g} m", length_m);
  if (length_m >= 1e-3) return fmt::format("{:.3g} mm", 1e3 * length_m);
  return fmt::format("{:.3g} um", 1e6 * length_m);
}

}  // namespace inkwell::importer
