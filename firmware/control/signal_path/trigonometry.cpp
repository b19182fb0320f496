#include "firmware/control/signal_path/trigonometry.hpp"

#include <bit>
#include <cstdint>

namespace inkwell::control {

namespace {

/// Each Newton step squares the relative error. With a seed error of up to 6 %, three steps reach float precision.
constexpr int newton_steps = 3;

/// sin(r) = r + r^3 P(r^2) and cos(r) = 1 - r^2 / 2 + r^4 Q(r^2) for |r| <= pi/4. The Remez algorithm computed the
/// coefficients, with errors of at most 1.8e-9 before rounding.
float sine_near_zero(float r) {
  const float u = r * r;
  return r + r * u * (-0.1666665067f + u * (0.008331978663f + u * -0.0001949563625f));
}

float cosine_near_zero(float r) {
  const float u = r * r;
  return 1.0f - 0.5f * u + u * u * (0.04166664687f + u * (-0.001388736752f + u * 2.443845159e-5f));
}

}  // namespace

SineCosine sine_cosine(float angle_rad) {
  constexpr float quarters_per_rad = 0.6366197724f;
  // This part of pi/2 has few significant bits, so that its product with the number of quarter turns is exact.
  constexpr float quarter_high_rad = 1.5703125f;
  constexpr float quarter_low_rad = 4.838267949e-4f;

  const float half = angle_rad < 0.0f ? -0.5f : 0.5f;
  const auto quarters = static_cast<std::int32_t>(angle_rad * quarters_per_rad + half);
  const auto whole = static_cast<float>(quarters);
  const float rest_rad = (angle_rad - whole * quarter_high_rad) - whole * quarter_low_rad;
  const float sine = sine_near_zero(rest_rad);
  const float cosine = cosine_near_zero(rest_rad);
  switch (quarters & 3) {
    case 0: return {sine, cosine};
    case 1: return {cosine, -sine};
    case 2: return {-sine, -cosine};
    default: return {-cosine, sine};
  }
}

float reciprocal(float value) {
  // Negates the exponent in the bit pattern. The seed error is at most 5.1 %.
  float estimate = std::bit_cast<float>(0x7EF31000u - std::bit_cast<std::uint32_t>(value));
  for (int i = 0; i < newton_steps; ++i) estimate *= 2.0f - value * estimate;
  return estimate;
}

// Not inlined, because copies of this code would fill the interrupt memory.
[[gnu::noinline]] float reciprocal_square_root(float value) { return find_reciprocal_square_root(value); }

bool is_finite(float value) {
  constexpr std::uint32_t exponent = 0x7F800000u;
  return (std::bit_cast<std::uint32_t>(value) & exponent) != exponent;
}

}  // namespace inkwell::control
