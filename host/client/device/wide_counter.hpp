// Board time in 64 bits.
#pragma once

#include <atomic>
#include <cstdint>

namespace inkwell::device {

/// A 64-bit counter. The board sends only the lower 32 bits. Control periods wrap after 59.7 hours, bus frames after
/// 49.7 days.
///
/// The upper bits count the wraps since the first value that this program noted. A value from before the board's last
/// wrap may therefore be negative. A value must be noted at least every 29 hours. Any thread may call any function.
class WideCounter {
 public:
  /// Returns the 64-bit value that ends with the bits of `value` and is nearest to `known`.
  static std::int64_t nearest_to(std::int64_t known, std::uint32_t value) {
    return known + static_cast<std::int32_t>(value - static_cast<std::uint32_t>(known));
  }
  /// Returns the smallest 64-bit value that ends with the bits of `value` and is at least `known`.
  static std::int64_t at_or_after(std::int64_t known, std::uint32_t value) {
    return known + static_cast<std::uint32_t>(value - static_cast<std::uint32_t>(known));
  }

  WideCounter() = default;
  WideCounter& operator=(const WideCounter& other) {
    newest_ = other.newest_.load();
    return *this;
  }

  /// The newest value; 0 before the first note().
  std::int64_t newest() const {
    const std::int64_t newest = newest_.load();
    return newest == nothing_noted ? 0 : newest;
  }

  /// Returns the 64-bit value that is nearest to the newest value. Before the first note(), returns the value itself.
  std::int64_t nearest(std::uint32_t value) const {
    const std::int64_t newest = newest_.load();
    return newest == nothing_noted ? std::int64_t{value} : nearest_to(newest, value);
  }

  /// Returns nearest(), and makes this value the newest value unless a newer value is known.
  std::int64_t note(std::uint32_t value) {
    const std::int64_t wide = nearest(value);
    raise_to(wide);
    return wide;
  }

  /// Continues the count of an earlier connection to the same board. The newest value of that connection was `before`.
  /// If the counter has decreased, the board has restarted and the counter keeps its value.
  void continue_from(std::int64_t before) {
    const std::int64_t newest = newest_.load();
    if (newest == nothing_noted) return;
    const auto value = static_cast<std::uint32_t>(newest);
    if (value >= static_cast<std::uint32_t>(before)) raise_to(at_or_after(before, value));
  }

 private:
  static constexpr std::int64_t nothing_noted = INT64_MIN;

  void raise_to(std::int64_t wide) {
    std::int64_t newest = newest_.load();
    while (wide > newest && !newest_.compare_exchange_weak(newest, wide)) {
    }
  }

  std::atomic<std::int64_t> newest_ = nothing_noted;
};

}  // namespace inkwell::device
