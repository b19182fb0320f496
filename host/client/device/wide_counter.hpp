// Board time in 64 bits.
#pragma once

#include <atomic>
#include <cstdint>

namespace inkwell::device {

/// A 64-bit counter whose lower 32 bits come from the board. The control period counter of the board wraps after 59.7
/// hours, and the bus frame counter wraps after 49.7 days.
///
/// The upper 32 bits count the wraps since the first noted value. A value from before the board's last wrap may
/// therefore be negative. The counter must be noted at least every 29 hours. Any thread may call any function.
class WideCounter {
 public:
  /// Of all 64-bit values with the lower bits `value`, returns the one nearest to `known`.
  static std::int64_t nearest_to(std::int64_t known, std::uint32_t value) {
    return known + static_cast<std::int32_t>(value - static_cast<std::uint32_t>(known));
  }
  /// Of all 64-bit values with the lower bits `value`, returns the smallest one that is at least `known`.
  static std::int64_t at_or_after(std::int64_t known, std::uint32_t value) {
    return known + static_cast<std::uint32_t>(value - static_cast<std::uint32_t>(known));
  }

  WideCounter() = default;
  WideCounter& operator=(const WideCounter& other) {
    newest_ = other.newest_.load();
    return *this;
  }

  /// Returns the newest value, or 0 before the first call of note().
  std::int64_t newest() const {
    const std::int64_t newest = newest_.load();
    return newest == nothing_noted ? 0 : newest;
  }

  /// Returns the 64-bit value nearest to the newest value. Returns `value` itself before the first call of note().
  std::int64_t nearest(std::uint32_t value) const {
    const std::int64_t newest = newest_.load();
    return newest == nothing_noted ? std::int64_t{value} : nearest_to(newest, value);
  }

  /// Returns nearest(), which becomes the newest value if it is larger.
  std::int64_t note(std::uint32_t value) {
    const std::int64_t wide = nearest(value);
    raise_to(wide);
    return wide;
  }

  /// Continues the count of an earlier connection whose newest value was `before`. Has no effect if the counter has
  /// decreased, because the board has restarted.
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
