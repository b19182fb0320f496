// Converts a duty cycle to the compare values of a bridge's legs.
#pragma once

#include <cstdint>

#include <board/board.hpp>

namespace inkwell::drivers {

/// Compare values of a bridge's legs.
struct LegCompares {
  std::uint16_t leg_a;
  std::uint16_t leg_b;
  bool operator==(const LegCompares&) const = default;
};

/// For a duty cycle u, the duty cycles of the legs are (1 + u) / 2 and (1 - u) / 2. The difference of the leg duty
/// cycles is rounded to steps of 1 / pwm_top. The duty cycle is limited to the board's limit. If the duty cycle is NaN,
/// the voltage is zero.
constexpr LegCompares leg_compares(float duty) {
  constexpr float limit = board::duty_limit;
  const float bounded = duty > limit ? limit : duty < -limit ? -limit : duty == duty ? duty : 0.0f;
  constexpr auto top = static_cast<std::int32_t>(board::pwm_top);
  // Adding one half rounds a positive value to the nearest integer.
  const auto difference = static_cast<std::int32_t>(bounded * top + (top + 0.5f)) - top;
  const std::int32_t leg_a = (top + difference) / 2;
  return {static_cast<std::uint16_t>(leg_a), static_cast<std::uint16_t>(leg_a - difference)};
}

inline constexpr LegCompares neutral_legs = leg_compares(0.0f);
inline constexpr LegCompares low_legs{0, 0};  ///< both low sides are on during the whole period

static_assert(neutral_legs == LegCompares{board::pwm_top / 2, board::pwm_top / 2});
static_assert(leg_compares(0.5f) == LegCompares{board::pwm_top * 3 / 4, board::pwm_top / 4});
static_assert(leg_compares(-0.5f) == LegCompares{board::pwm_top / 4, board::pwm_top * 3 / 4});
static_assert(leg_compares(1.0f / board::pwm_top).leg_a == leg_compares(1.0f / board::pwm_top).leg_b + 1);
static_assert(leg_compares(-1.0f / board::pwm_top).leg_a + 1 == leg_compares(-1.0f / board::pwm_top).leg_b);
static_assert(leg_compares(7.0f) == leg_compares(board::duty_limit));
static_assert(leg_compares(7.0f).leg_a < board::pwm_top && leg_compares(7.0f).leg_b > 0);
static_assert(leg_compares(-7.0f) == leg_compares(-board::duty_limit));
static_assert(leg_compares(__builtin_nanf("")) == neutral_legs);

}  // namespace inkwell::drivers
