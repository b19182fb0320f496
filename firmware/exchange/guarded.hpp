// A checksum detects flipped bits in long-lived values of the main loop.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace inkwell::link {

/// Returns a checksum. Values that differ in one bit have different checksums.
template <class T>
std::uint32_t sum_of(const T& value) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof value % sizeof(std::uint32_t) == 0);
  const auto* bytes = reinterpret_cast<const std::byte*>(&value);
  std::uint32_t sum = 0;
  for (std::size_t at = 0; at < sizeof value; at += sizeof sum) {
    std::uint32_t word;
    std::memcpy(&word, bytes + at, sizeof word);
    sum = std::rotl(sum, 1) ^ word;
  }
  return sum;
}

/// A value with its checksum. A copy of a damaged value is detected, because the checksum is copied.
template <class T>
class Guarded {
 public:
  explicit Guarded(const T& value) { put(value); }

  void put(const T& value) {
    value_ = value;
    seal();
  }
  /// Allows direct changes. Call seal() after the last change.
  T& open() { return value_; }
  void seal() { sum_ = sum_of(value_); }

  const T& value() const { return value_; }
  /// Returns true if the value is unchanged since put() or seal().
  bool is_intact() const { return sum_of(value_) == sum_; }

 private:
  T value_;
  std::uint32_t sum_;
};

}  // namespace inkwell::link
