// Units of length in files.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace inkwell::importer {

enum class Unit : std::uint8_t { millimeter, centimeter, meter, inch };

inline constexpr std::array all_units{Unit::millimeter, Unit::centimeter, Unit::meter, Unit::inch};

/// Symbol of the unit: mm, cm, m, in.
std::string_view symbol_of(Unit unit);

double meters_per(Unit unit);

std::optional<Unit> parse_unit(std::string_view symbol);

/// The unit that makes an object comfortable to touch, for files without a unit. `length`: longest side of the object,
/// in the unit of the file. Millimeters precede meters, which precede the other units.
Unit propose_unit(double length);

/// Length with the unit m, mm or um and three digits, for sentences: "80 mm".
std::string length_text(double length_m);

}  // namespace inkwell::importer
