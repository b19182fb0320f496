// Unit vectors in reports, as octahedral coordinates (Meyer et al., "On floating-point normal vectors", EGSR 2010). The
// largest error of a decoded direction is 5e-5 rad.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace inkwell::protocol {

inline constexpr float direction_scale = 32767.0f;

namespace detail {
constexpr float with_sign(float value, float sign) { return sign < 0.0f ? -value : value; }
}  // namespace detail

/// Returns the octahedral coordinates of a vector with any length except 0.
inline std::array<std::int16_t, 2> encode_direction(const std::array<float, 3>& vector) {
  const float length = std::fabs(vector[0]) + std::fabs(vector[1]) + std::fabs(vector[2]);
  const float x = vector[0] / length, y = vector[1] / length;
  const bool is_lower = vector[2] < 0.0f;
  const float u = is_lower ? detail::with_sign(1.0f - std::fabs(y), x) : x;
  const float v = is_lower ? detail::with_sign(1.0f - std::fabs(x), y) : y;
  return {static_cast<std::int16_t>(std::lround(u * direction_scale)),
          static_cast<std::int16_t>(std::lround(v * direction_scale))};
}

/// Returns a unit vector for any pair of coordinates.
inline std::array<float, 3> decode_direction(const std::int16_t (&direction)[2]) {
  const float u = static_cast<float>(direction[0]) / direction_scale;
  const float v = static_cast<float>(direction[1]) / direction_scale;
  const float z = 1.0f - std::fabs(u) - std::fabs(v);
  const float x = z < 0.0f ? detail::with_sign(1.0f - std::fabs(v), u) : u;
  const float y = z < 0.0f ? detail::with_sign(1.0f - std::fabs(u), v) : v;
  // The sum of the magnitudes is about 1, so the length is not 0.
  const float per_length = 1.0f / std::sqrt(x * x + y * y + z * z);
  return {per_length * x, per_length * y, per_length * z};
}

/// Returns two unit vectors that are orthogonal to a unit vector and to each other (Duff et al., "Building an
/// orthonormal basis, revisited", JCGT 2017).
inline std::array<std::array<float, 3>, 2> across(const std::array<float, 3>& axis) {
  const float sign = axis[2] < 0.0f ? -1.0f : 1.0f;
  const float a = -1.0f / (sign + axis[2]);
  const float b = axis[0] * axis[1] * a;
  return {
      {{1.0f + sign * axis[0] * axis[0] * a, sign * b, -sign * axis[0]}, {b, sign + axis[1] * axis[1] * a, -axis[1]}}};
}

}  // namespace inkwell::protocol
