// Sine, cosine, reciprocal and reciprocal square root in float, without libm and without division.
#pragma once

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

/// Returns false for infinities and NaN. This test works with -ffinite-math-only.
bool is_finite(float value);

}  // namespace inkwell::control
