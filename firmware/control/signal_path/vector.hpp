// Basic types of the signal path.
#pragma once

#include <array>
#include <cstddef>

namespace inkwell::control {

/// One value for each joint, motor, encoder or potentiometer, in arm order.
using Triple = std::array<float, 3>;

/// Point or direction in the workspace.
struct Vector3 {
  float x = 0.0f;
  float y = 0.0f;
  float z = 0.0f;
  bool operator==(const Vector3&) const = default;
};

constexpr Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vector3 operator*(float s, const Vector3& a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr float dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Limits `value` to [low, high]. This form compiles to code without branches.
constexpr float clamp(float value, float low, float high) { return value < low ? low : (value > high ? high : value); }

}  // namespace inkwell::control
