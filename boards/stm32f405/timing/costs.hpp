// Costs of the Cortex-M4F and the STM32F405 in cycles of HCLK. The build generates <timing/cost_rows.hpp> from the
// values in boards/stm32f405/timing/costs.toml.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <timing/cost_rows.hpp>

namespace inkwell::virtual_board {

/// Selects the likely or the conservative value of each cost.
enum class Pricing : std::uint8_t { likely, conservative };

/// Source of a value.
enum class Source : std::uint8_t {
  reference_manual,  ///< ARM technical reference manuals of the Cortex-M4 (DDI 0439) and M3 (DDI 0337)
  compiler,          ///< scheduling description of the Cortex-M4 in GCC
  chip_manual,       ///< RM0090
  measured,          ///< published measurements on an STM32F407
  guess,             ///< no source; needs a measurement on a board
};

enum class Cost : std::uint8_t {
#define X(name, ...) name,
  INKWELL_COSTS(X)
#undef X
};

struct CostInfo {
  Cost cost;
  std::string_view name;
  std::uint8_t likely, conservative;
  Source source;
};

inline constexpr CostInfo cost_table[] = {
#define X(name, likely, conservative, source) {Cost::name, #name, likely, conservative, Source::source},
    INKWELL_COSTS(X)
#undef X
};

// For prefetched_line_is_cached the smaller value is conservative, because fewer lines enter the cache.
static_assert([] {
  for (const CostInfo& row : cost_table)
    if (row.likely > row.conservative && row.cost != Cost::prefetched_line_is_cached) return false;
  return true;
}());

/// The cost values of one Pricing.
class Costs {
 public:
  constexpr explicit Costs(Pricing pricing) : pricing_(pricing) {}
  constexpr unsigned operator[](Cost cost) const {
    const auto& row = cost_table[static_cast<std::size_t>(cost)];
    return pricing_ == Pricing::likely ? row.likely : row.conservative;
  }
  constexpr Pricing pricing() const { return pricing_; }

 private:
  Pricing pricing_;
};

}  // namespace inkwell::virtual_board
