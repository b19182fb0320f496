// Sine, cosine, reciprocal and reciprocal square root in float, without libm and without division.
#pragma once

#include <bit>
#include <cstdint>

namespace inkwell::control {

struct SineCosine {
  float sine;
  float cosine;
};

/// The absolute error is at most 1.2e-7 for |angle| up to 20 rad.
SineCosine sine_cosine(float angle_rad);

/// Returns 1 / value for a positive normal value below 1e37. The relative error is at most 2e-7.
float reciprocal(float value);

/// Returns 1 / sqrt(value) for a positive normal value. The relative error is at most 3e-7.
float reciprocal_square_root(float value);

/// The same without a function call.
[[gnu::always_inline]] inline float find_reciprocal_square_root(float value) {
  // Halves and negates the exponent in the bit pattern. The seed error is at most 3.5 %.
  float estimate = std::bit_cast<float>(0x5F376400u - (std::bit_cast<std::uint32_t>(value) >> 1));
  const float half = 0.5f * value;
  estimate *= 1.5f - half * estimate * estimate;
  estimate *= 1.5f - half * estimate * estimate;
  estimate *= 1.5f - half * estimate * estimate;
  return estimate;
}

/// Returns false for infinities and NaN. This test works with -ffinite-math-only.
bool is_finite(float value);

}  // namespace inkwell::control
