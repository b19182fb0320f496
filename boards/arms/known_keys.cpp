#include "boards/arms/known_keys.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace inkwell::arms {
namespace {

struct Unit {
  std::string_view suffix;
  std::string_view rule;
};

// The first matching suffix is used, so `_Nm_per_rad` precedes `_rad`.
constexpr Unit units[] = {
    {"_counts_per_turn", "encoders are in counts per turn"},
    {"_Nms_per_rad", "damping is in newton metre seconds per radian"},
    {"_Nm_per_rad", "stiffness is in newton metres per radian"},
    {"_V_per_As", "integral gains are in volts per ampere second"},
    {"_V_per_A", "proportional gains are in volts per ampere"},
    {"_Nm_per_A", "torque constants are in newton metres per ampere"},
    {"_m_per_s2", "accelerations are in metres per second squared"},
    {"_kg_m2", "inertias are in kilogram square metres"},
    {"_ohm", "resistances are in ohms"},
    {"_rad", "angles are in radians"},
    {"_Nm", "torques are in newton metres"},
    {"_kg", "masses are in kilograms"},
    {"_m", "lengths are in metres"},
    {"_H", "inductances are in henries"},
    {"_A", "currents are in amperes"},
};

// Common unit suffixes that arm descriptions do not use. The empty string represents a key without a unit.

// clang-format off
constexpr std::string_view foreign_units[] = {
    "", "mm", "cm", "um", "in", "inch", "metre", "metres", "meter", "meters", "deg", "degree", "degrees", "radians",
    "mrad", "g", "gram", "grams", "mA", "amperes", "amps", "mNm", "Ncm", "mH", "uH", "mohm", "kohm", "ohms", "Ohm",
    "gcm2", "g_cm2", "kgm2", "kg_cm2", "mNm_per_A", "Nm_A", "g_per_s2", "mm_per_s2", "m_s2", "lines_per_turn",
    "pulses_per_turn", "counts", "Nm_per_deg", "Nms_per_deg", "m", "rad", "kg", "Nm", "H", "A", "ohm"};
// clang-format on

/// Returns the unit rule of `known` if `key` is the same quantity in another unit. Otherwise returns an empty string.
std::string_view unit_rule(std::string_view key, std::string_view known) {
  for (const Unit& unit : units) {
    if (!known.ends_with(unit.suffix)) continue;
    const auto quantity = known.substr(0, known.size() - unit.suffix.size());
    if (!key.starts_with(quantity)) return {};
    auto rest = key.substr(quantity.size());
    if (!rest.empty() && rest.front() != '_') return {};
    if (!rest.empty()) rest.remove_prefix(1);
    return std::ranges::find(foreign_units, rest) != std::end(foreign_units) ? unit.rule : std::string_view{};
  }
  return {};
}

/// Levenshtein distance: insertions, deletions and replacements between two words.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string advice_for(std::string_view key, std::span<const std::string_view> known) {
  for (const auto candidate : known)
    if (const auto rule = unit_rule(key, candidate); !rule.empty()) return fmt::format("{}: {}", rule, candidate);
  const auto nearest = std::ranges::min_element(known, {}, [&](auto candidate) { return distance(key, candidate); });
  if (nearest != known.end() && 3 * distance(key, *nearest) <= std::max(key.size(), nearest->size()))
    return fmt::format("did you mean {}?", *nearest);
  if (known.size() <= 8) return fmt::format("known here: {}", fmt::join(known, ", "));
  return "remove it, or see omni.toml for the keys that are known here";
}

}  // namespace inkwell::arms
